#include "scenarios/yaml_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace nightjar::scenarios {
namespace {

using Kind = YamlNode::Kind;

// The node's value as a message quotes it.
std::string value_text(const YamlNode& node) {
  switch (node.kind) {
    case Kind::null: return "nothing";
    case Kind::map: return "a section";
    case Kind::sequence: return "a list";
    case Kind::scalar: break;
  }
  return node.quoted ? '"' + shown(node.text) + '"' : shown(node.text);
}

// A plain scalar as a number; nothing for any other text, for NaN and for infinity.
template <class Number>
std::optional<Number> parse_number(const YamlNode& node) {
  if (node.kind != Kind::scalar || node.quoted) return std::nullopt;
  std::string_view text = node.text;
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.begin(), text.end(), value);
  if (error != std::errc() || end != text.end()) return std::nullopt;
  if (!std::isfinite(static_cast<double>(value))) return std::nullopt;
  return value;
}

// Levenshtein's distance, the fewest letters to insert, drop or change, of `a`
// from any beginning of `b`, then from all of it: the unit that ends a name is
// what people forget.
std::pair<std::size_t, std::size_t> distances(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, diagonal + 1, row[j] + 1});
    }
  }
  return {*std::min_element(row.begin(), row.end()), row.back()};
}

}  // namespace

YamlReader::YamlReader(const YamlNode& map, std::string file, std::string path)
    : file_(std::move(file)), path_(std::move(path)) {
  if (map.kind != Kind::map && path_.empty()) fail(map, "expected `name: value` lines");
  if (map.kind != Kind::map)
    fail(map, fmt::format("{} = {}, expected a section", path_, value_text(map)));
  for (const YamlNode& member : map.children) {
    members_.push_back(&member);
    const auto [first, is_new] = by_key_.emplace(member.key, &member);
    if (!is_new)
      fail(member, fmt::format("{}: duplicate key, first on line {}", at(shown(member.key)),
                               first->second->line));
  }
}

void YamlReader::field(const char* name, double& value, double least, double greatest,
                       const core::Origin&) {
  if (const YamlNode* node = find(name)) value = number(*node, at(name), least, greatest);
}

void YamlReader::field(const char* name, int& value, int least, int greatest, const core::Origin&) {
  const YamlNode* node = find(name);
  if (!node) return;
  // A whole number too large for an int is still out of range, not text.
  const auto whole = parse_number<long long>(*node);
  if (!whole)
    fail(*node, fmt::format("{} = {}, expected a whole number from {} to {}", at(name),
                            value_text(*node), least, greatest));
  if (*whole < least || *whole > greatest)
    fail(*node, fmt::format("{} = {}, allowed {} to {}", at(name), *whole, least, greatest));
  value = static_cast<int>(*whole);
}

void YamlReader::field(const char* name, bool& value, const core::Origin&) {
  const YamlNode* node = find(name);
  if (!node) return;
  const bool plain = node->kind == Kind::scalar && !node->quoted;
  if (!plain || (node->text != "true" && node->text != "false"))
    fail(*node, fmt::format("{} = {}, expected true or false", at(name), value_text(*node)));
  value = node->text == "true";
}

void YamlReader::field(const char* name, std::string& value, const core::Origin&) {
  const YamlNode* node = find(name);
  if (!node) return;
  if (node->kind != Kind::scalar)
    fail(*node, fmt::format("{} = {}, expected text", at(name), value_text(*node)));
  value = node->text;
}

void YamlReader::finish() const {
  for (const YamlNode* member : members_)
    if (std::find(asked_.begin(), asked_.end(), member->key) == asked_.end()) fail_unknown(*member);
}

const YamlNode* YamlReader::find(const char* name) {
  asked_.emplace_back(name);
  const auto found = by_key_.find(name);
  return found == by_key_.end() ? nullptr : found->second;
}

const YamlNode* YamlReader::find_list(const char* name, std::size_t least, std::size_t greatest) {
  const YamlNode* node = find(name);
  if (!node) return nullptr;
  if (node->kind != Kind::sequence)
    fail(*node, fmt::format("{} = {}, expected a list", at(name), value_text(*node)));
  if (node->children.size() < least || node->children.size() > greatest)
    fail(*node, fmt::format("{}.size = {}, allowed {} to {}", at(name), node->children.size(),
                            least, greatest));
  return node;
}

void YamlReader::read_numbers(const char* name, std::span<double> values, double least,
                              double greatest) {
  const YamlNode* node = find(name);
  if (!node) return;
  if (node->kind != Kind::sequence)
    fail(*node, fmt::format("{} = {}, expected a list of {} numbers", at(name), value_text(*node),
                            values.size()));
  if (node->children.size() != values.size())
    fail(*node, fmt::format("{}: a list of {}, expected {} numbers", at(name),
                            node->children.size(), values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = number(node->children[i], fmt::format("{}[{}]", at(name), i), least, greatest);
}

std::size_t YamlReader::read_choice(const char* name, std::span<const char* const> names) {
  const YamlNode* node = find(name);
  if (!node) return names.size();
  const auto found =
      node->kind == Kind::scalar ? std::find(names.begin(), names.end(), node->text) : names.end();
  if (found == names.end())
    fail(*node,
         fmt::format("{} = {}, allowed: {}", at(name), value_text(*node), fmt::join(names, ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

double YamlReader::number(const YamlNode& node, const std::string& path, double least,
                          double greatest) const {
  const auto value = parse_number<double>(node);
  if (!value)
    fail(node, fmt::format("{} = {}, expected a number from {} to {}", path, value_text(node),
                           core::number_text(least), core::number_text(greatest)));
  // Quoted as written: rounding could make a value just outside look allowed.
  if (*value < least || *value > greatest)
    fail(node, fmt::format("{} = {}, allowed {} to {}", path, value_text(node),
                           core::number_text(least), core::number_text(greatest)));
  return *value;
}

void YamlReader::fail(const YamlNode& node, const std::string& message) const {
  throw ScenarioError(fmt::format("{}:{}:{}: {}", file_, node.line, node.column, message));
}

void YamlReader::fail_unknown(const YamlNode& node) const {
  const std::string key = shown(node.key);
  const auto nearest = std::min_element(asked_.begin(), asked_.end(),
                                        [&key](const std::string& a, const std::string& b) {
                                          return distances(key, a) < distances(key, b);
                                        });
  fail(node, fmt::format("{}: unknown key, nearest is {}; allowed: {}", at(key),
                         nearest == asked_.end() ? "none" : *nearest, fmt::join(asked_, ", ")));
}

}  // namespace nightjar::scenarios
