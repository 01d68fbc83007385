#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/config_check.h"
#include "scenarios/scenario_error.h"
#include "scenarios/yaml_tree.h"

namespace nightjar::scenarios {

/// A visitor (core/config_check.h) that fills a config struct from a map of a
/// scenario file. Absent keys keep their defaults. Throws ScenarioError, with
/// file, line, column and dotted path, for a duplicate key, a value of the wrong
/// type or out of range, and, in finish(), for a key nobody asked for.
class YamlReader {
 public:
  /// Reads members of `map`, which has to outlive the reader; `path` is the
  /// section's dotted name, empty for the whole file.
  YamlReader(const YamlNode& map, std::string file, std::string path);

  void field(const char* name, double& value, double least, double greatest,
             const core::Origin& = {});
  void field(const char* name, int& value, int least, int greatest, const core::Origin& = {});
  void field(const char* name, bool& value, const core::Origin& = {});
  void field(const char* name, std::string& value, const core::Origin& = {});
  template <std::size_t N>
  void field(const char* name, std::array<double, N>& value, double least, double greatest,
             const core::Origin& = {}) {
    read_numbers(name, value, least, greatest);
  }

  template <class Enum, std::size_t N>
  void choice(const char* name, Enum& value, const core::Choices<Enum, N>& choices,
              const core::Origin& = {}) {
    std::array<const char*, N> names{};
    for (std::size_t i = 0; i < N; ++i) names[i] = choices[i].first;
    if (const auto chosen = read_choice(name, names); chosen < N) value = choices[chosen].second;
  }

  template <class Config>
  void section(const char* name, Config& config) {
    if (const YamlNode* node = find(name)) read(*node, at(name), config);
  }

  /// A list in the file replaces the whole default list.
  template <class Config>
  void list(const char* name, std::vector<Config>& configs, std::size_t least,
            std::size_t greatest) {
    const YamlNode* node = find_list(name, least, greatest);
    if (!node) return;
    configs.assign(node->children.size(), Config{});
    for (std::size_t i = 0; i < configs.size(); ++i)
      read(node->children[i], at(name) + '[' + std::to_string(i) + ']', configs[i]);
  }

  /// Throws ScenarioError at the first key that no call above asked for.
  void finish() const;

 private:
  template <class Config>
  void read(const YamlNode& node, const std::string& path, Config& config) const {
    YamlReader inner(node, file_, path);
    config.visit(inner);
    inner.finish();
  }

  std::string at(const std::string& name) const {
    return path_.empty() ? name : path_ + '.' + name;
  }
  const YamlNode* find(const char* name);
  const YamlNode* find_list(const char* name, std::size_t least, std::size_t greatest);
  void read_numbers(const char* name, std::span<double> values, double least, double greatest);
  std::size_t read_choice(const char* name, std::span<const char* const> names);
  double number(const YamlNode& node, const std::string& path, double least, double greatest) const;
  [[noreturn]] void fail(const YamlNode& node, const std::string& message) const;
  [[noreturn]] void fail_unknown(const YamlNode& node) const;

  std::string file_;
  std::string path_;
  std::vector<const YamlNode*> members_;  ///< In the file's order.
  std::map<std::string, const YamlNode*> by_key_;
  std::vector<std::string> asked_;  ///< Names the config struct declares.
};

/// Fills `config` from the document `text`; `file` names it in messages.
template <class Config>
void read_yaml(const std::string& text, const std::string& file, Config& config) {
  const YamlNode root = parse_yaml(text, file);
  YamlReader reader(root, file, "");
  config.visit(reader);
  reader.finish();
}

}  // namespace nightjar::scenarios
