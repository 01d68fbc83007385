#include "camera/info_xml.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>
#include <vector>

namespace nightjar::camera {
namespace {

constexpr std::size_t kMostDepth = 16;

constexpr std::array<std::pair<std::string_view, char>, 5> kEntities = {
    {{"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}}};

[[noreturn]] void fail(const std::string& why) {
  throw std::invalid_argument("the header's XML: " + why);
}

std::string unescaped(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    char c = text.front();
    std::size_t length = 1;
    for (const auto& [entity, meaning] : kEntities)
      if (text.starts_with(entity)) {
        c = meaning;
        length = entity.size();
        break;
      }
    plain += c;
    text.remove_prefix(length);
  }
  return plain;
}

/// What `name="..."` says in `tag`; empty without it.
std::string value_of(std::string_view tag, const std::string& name) {
  const std::string opening = " " + name + "=\"";
  const std::size_t at = tag.find(opening);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = tag.substr(at + opening.size());
  return unescaped(rest.substr(0, rest.find('"')));
}

/// Takes up to and with `end` off the text, and returns what stands before `end`.
std::string_view take_until(std::string_view& text, std::string_view end) {
  const std::size_t at = text.find(end);
  if (at == std::string_view::npos) fail("no " + std::string(end));
  const std::string_view taken = text.substr(0, at);
  text.remove_prefix(at + end.size());
  return taken;
}

std::string joined(const std::vector<std::string>& nodes, const std::string& key) {
  std::string path;
  for (const std::string& node : nodes) path += node + '/';
  return path + key;
}

}  // namespace

std::map<std::string, std::string> read_info_xml(std::string_view xml) {
  std::map<std::string, std::string> attributes;
  std::vector<std::string> nodes;
  while (xml.find('<') != std::string_view::npos) {
    take_until(xml, "<");
    const std::string_view tag = take_until(xml, ">");
    if (tag.starts_with("attr ") && !tag.ends_with('/')) {
      attributes[joined(nodes, value_of(tag, "key"))] = unescaped(take_until(xml, "</attr>"));
    } else if (tag.starts_with("node ") && !tag.ends_with('/')) {
      if (nodes.size() == kMostDepth) fail("nodes too deep");
      nodes.push_back(value_of(tag, "name"));
    } else if (tag == "/node") {
      if (nodes.empty()) fail("</node> without <node>");
      nodes.pop_back();
    }
  }
  if (!nodes.empty()) fail("<node> without </node>");
  return attributes;
}

std::string escaped_xml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    const auto* found = std::find_if(kEntities.begin(), kEntities.end(),
                                     [&](const auto& entity) { return entity.second == c; });
    if (found == kEntities.end())
      escaped += c;
    else
      escaped += found->first;
  }
  return escaped;
}

}  // namespace nightjar::camera
