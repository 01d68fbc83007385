#include "tests/support/rules_include_checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>

namespace nightjar::rules {
namespace fs = std::filesystem;
namespace {

// Who may include whom, beside itself.
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"core", {}},
    {"msg", {"core"}},
    {"sim", {"core"}},
    {"camera", {"core"}},
    {"esi", {"core"}},
    {"tracker", {"core"}},
    {"scenarios", {"core", "msg", "sim", "camera", "esi", "tracker"}},
    {"tools", {"core", "msg", "sim", "camera", "esi", "tracker", "scenarios"}},
};

// External headers that one folder alone may see.
const std::map<std::string, std::string> kOwner = {
    {"mujoco", "sim"}, {"GL", "sim"},           {"libcaer", "camera"},     {"libcaercpp", "camera"},
    {"lcm", "msg"},    {"nightjar_lcm", "msg"}, {"yaml-cpp", "scenarios"}, {"apriltag", "tracker"},
};

// External headers that one file of a folder alone may see: what find_package(nightjar)
// gives needs core and nothing heavier.
const std::map<std::string, std::map<std::string, std::string>> kOnlyFile = {
    {"esi", {{"opencv2", "esi/recurrent_network.cc"}}},
};

// External headers that a public header may show: Eigen's types are core's own,
// and nightjar_lcm's are made from msg/*.lcm.
const std::set<std::string> kAllowedInHeaders = {"Eigen", "nightjar_lcm"};

std::string top_folder(const std::string& path) {
  const auto slash = path.find('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

// libapriltag's headers may be included with and without their folder.
std::string library_of(const std::string& path) {
  static const std::regex kBareAprilTag(R"((apriltag|tag[0-9A-Z])[^/]*\.h)");
  return std::regex_match(path, kBareAprilTag) ? "apriltag" : top_folder(path);
}

bool is_project(const std::string& path) { return kMayInclude.contains(top_folder(path)); }
bool is_header(const std::string& file) { return file.ends_with(".h"); }
bool is_config(const std::string& file) { return file.ends_with("config.h"); }

// The library esi_networks, which is not installed.
bool is_network(const std::string& file) {
  static const std::regex kNetworks(
      R"(esi/(make_network|onnx_signature|recurrent_network)\.(h|cc))");
  return std::regex_match(file, kNetworks);
}

// <vector>, <cmath>: without a folder and without an ending.
bool is_standard(const std::string& path) { return path.find_first_of("/.") == std::string::npos; }

std::optional<std::string> broken_project_rule(const Include& include) {
  const std::string from = top_folder(include.file);
  const std::string to = top_folder(include.path);
  if (from != to && !kMayInclude.at(from).contains(to)) return from + " may not see " + to;
  if (from == to && is_network(include.path) && !is_network(include.file))
    return "only the networks and those who use esi may see " + include.path;
  const bool own_config = from == to && is_config(include.path);
  if (is_config(include.file) && to != "core" && !own_config)
    return "a config header sees core and its folder's configs only";
  return std::nullopt;
}

std::optional<std::string> only_file(const std::string& folder, const std::string& library) {
  const auto files = kOnlyFile.find(folder);
  if (files == kOnlyFile.end() || !files->second.contains(library)) return std::nullopt;
  return files->second.at(library);
}

std::optional<std::string> broken_external_rule(const Include& include) {
  if (is_standard(include.path)) return std::nullopt;
  const std::string from = top_folder(include.file);
  const std::string library = library_of(include.path);
  if (const auto owner = kOwner.find(library); owner != kOwner.end() && owner->second != from)
    return "only " + owner->second + " may see " + library;
  if (is_config(include.file)) return "a config header sees no external header";
  if (const auto file = only_file(from, library); file && *file != include.file)
    return "of " + from + " only " + *file + " may see " + library;
  if (is_header(include.file) && !kAllowedInHeaders.contains(library))
    return "a public header sees no external header";
  return std::nullopt;
}

using Graph = std::map<std::string, std::vector<std::string>>;

bool reaches(const Graph& graph, const std::string& from, const std::string& target,
             std::set<std::string>& seen) {
  if (from == target) return true;
  const auto next = graph.find(from);
  if (next == graph.end() || !seen.insert(from).second) return false;
  return std::any_of(next->second.begin(), next->second.end(),
                     [&](const std::string& each) { return reaches(graph, each, target, seen); });
}

// The loop under test must not see what really is.
std::optional<std::string> leaked_truth(const Include& include, const Graph& graph) {
  const std::string from = top_folder(include.file);
  std::set<std::string> seen;
  if (from != "esi" && from != "tracker") return std::nullopt;
  if (!reaches(graph, include.path, "core/truth.h", seen)) return std::nullopt;
  return from + " may not reach core/truth.h";
}

// Of scenarios, these two carry the loop under test.
bool is_blind_node(const std::string& file) {
  static const std::regex kBlind(R"(scenarios/(reconstruction|tracker)_node\.(h|cc))");
  return std::regex_match(file, kBlind);
}

std::optional<std::string> broken_node_rule(const Include& include) {
  if (!is_blind_node(include.file) || include.path != "core/truth.h") return std::nullopt;
  return "a node under test may not see core/truth.h";
}

void read_file(const fs::path& root, const fs::path& path, std::vector<Include>& includes) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"].*)");
  std::ifstream stream(path);
  std::string text;
  std::smatch match;
  for (int line = 1; std::getline(stream, text); ++line)
    if (std::regex_match(text, match, kInclude))
      includes.push_back({fs::relative(path, root).generic_string(), line, match[1].str()});
}

// Every .h and .cc file of the project's folders.
std::set<fs::path> sources(const fs::path& root) {
  std::set<fs::path> files;
  for (const auto& [folder, allowed] : kMayInclude) {
    if (!fs::is_directory(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cc")
        files.insert(entry.path());
  }
  return files;
}

}  // namespace

std::vector<std::string> truth_listeners(const fs::path& root) {
  static const std::regex kName(R"(.*\bkTruth\b.*)");
  std::vector<std::string> found;
  for (const fs::path& path : sources(root)) {
    const std::string file = fs::relative(path, root).generic_string();
    if (!is_blind_node(file)) continue;
    std::ifstream stream(path);
    std::string text;
    for (int line = 1; std::getline(stream, text); ++line)
      if (std::regex_match(text, kName))
        found.push_back(fmt::format("{}:{}: names kTruth: a node under test may not", file, line));
  }
  return found;
}

std::vector<Include> read_includes(const fs::path& root) {
  std::vector<Include> includes;
  for (const fs::path& file : sources(root)) read_file(root, file, includes);
  return includes;
}

std::vector<std::string> violations(const std::vector<Include>& includes) {
  Graph graph;
  for (const Include& include : includes) graph[include.file].push_back(include.path);
  std::vector<std::string> found;
  for (const Include& include : includes) {
    auto why =
        is_project(include.path) ? broken_project_rule(include) : broken_external_rule(include);
    if (!why) why = leaked_truth(include, graph);
    if (!why) why = broken_node_rule(include);
    if (why)
      found.push_back(
          fmt::format("{}:{}: includes {}: {}", include.file, include.line, include.path, *why));
  }
  return found;
}

}  // namespace nightjar::rules
