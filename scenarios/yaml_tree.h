#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nightjar::scenarios {

/// One node of a parsed file, with the place a person has to look at.
struct YamlNode {
  enum class Kind { null, scalar, map, sequence };

  Kind kind = Kind::null;
  int line = 1;                    ///< Counted from 1; of the key for a map's member, else its own.
  int column = 1;                  ///< Counted from 1, in characters.
  std::string key;                 ///< Members of a map only.
  std::string text;                ///< Scalars only, quotes and escapes removed.
  bool quoted = false;             ///< Scalars only: "5" is text, 5 may be a number.
  std::vector<YamlNode> children;  ///< Of maps and sequences, in the file's order.
};

/// The one YAML document in `text`; `file` names it in messages. Throws
/// ScenarioError for a syntax error, an empty document, a second document,
/// anchors, aliases, tags, keys that are not text, more than 1 MiB, or nesting
/// deeper than 32.
YamlNode parse_yaml(const std::string& text, const std::string& file);

/// The whole file, at most 1 MiB of it. Throws ScenarioError for a missing or
/// unreadable file, a directory, or a larger file.
std::string read_scenario_text(const std::filesystem::path& path);

}  // namespace nightjar::scenarios
