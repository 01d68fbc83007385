#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nightjar::rules {

/// One #include line of a source file; quotes and brackets are removed.
struct Include {
  std::string file;  ///< Which includes, from the root: "sim/scene.cc".
  int line = 0;      ///< Counted from 1.
  std::string path;  ///< What is included: "core/event.h", "vector".
};

/// Every #include of every .h and .cc file in the project's folders below `root`,
/// ordered by file and line.
std::vector<Include> read_includes(const std::filesystem::path& root);

/// One line "file:line: names kTruth: why not" for each line of the nodes under test
/// (reconstruction, tracker) that names the channel of the truth; empty when all is well.
std::vector<std::string> truth_listeners(const std::filesystem::path& root);

/// One line "file:line: includes path: why not" for each include that breaks a
/// rule; empty when all is well. The rules stand in the .cc file.
std::vector<std::string> violations(const std::vector<Include>& includes);

}  // namespace nightjar::rules
