#include "scenarios/yaml_tree.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "scenarios/scenario_error.h"

namespace nightjar::scenarios {
namespace {

constexpr std::size_t kMostBytes = 1 << 20;
constexpr std::size_t kMostLevels = 32;

[[noreturn]] void fail_at(const std::string& file, int line, int column,
                          const std::string& message) {
  throw ScenarioError(fmt::format("{}:{}:{}: {}", file, line, column, message));
}

// yaml-cpp's own tree keeps duplicate keys silently and follows aliases, so the
// tree is built from its parser's events instead.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::string file) : file_(std::move(file)) {}

  std::optional<YamlNode> take_root() { return std::exchange(root_, std::nullopt); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(node(mark, YamlNode::Kind::null, "", anchor));
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    fail(mark, "aliases (*name) are not allowed");
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    YamlNode scalar = node(mark, YamlNode::Kind::scalar, tag, anchor);
    scalar.text = value;
    scalar.quoted = tag == "!";
    add(std::move(scalar));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, node(mark, YamlNode::Kind::sequence, tag, anchor));
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, node(mark, YamlNode::Kind::map, tag, anchor));
  }
  void OnMapEnd() override { close(); }

 private:
  struct Level {
    YamlNode node;
    std::optional<YamlNode> key;  // read, and still without its value
  };

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& message) const {
    fail_at(file_, mark.line + 1, mark.column + 1, message);
  }

  YamlNode node(const YAML::Mark& mark, YamlNode::Kind kind, const std::string& tag,
                YAML::anchor_t anchor) const {
    if (anchor != YAML::NullAnchor) fail(mark, "anchors (&name) are not allowed");
    if (!tag.empty() && tag != "?" && tag != "!") fail(mark, "tags (!name) are not allowed");
    YamlNode made;
    made.kind = kind;
    made.line = mark.line + 1;
    made.column = mark.column + 1;
    return made;
  }

  void open(const YAML::Mark& mark, YamlNode made) {
    if (levels_.size() == kMostLevels)
      fail(mark, fmt::format("nested deeper than {} levels", kMostLevels));
    levels_.push_back({std::move(made), std::nullopt});
  }

  void close() {
    YamlNode done = std::move(levels_.back().node);
    levels_.pop_back();
    add(std::move(done));
  }

  void add(YamlNode made) {
    if (levels_.empty()) {
      root_ = std::move(made);
      return;
    }
    Level& level = levels_.back();
    if (level.node.kind == YamlNode::Kind::map && !level.key) {
      if (made.kind != YamlNode::Kind::scalar)
        fail_at(file_, made.line, made.column, "a key has to be a name");
      level.key = std::move(made);
      return;
    }
    if (level.key) {  // a value is looked for where its key stands
      made.key = level.key->text;
      made.line = level.key->line;
      made.column = level.key->column;
      level.key.reset();
    }
    level.node.children.push_back(std::move(made));
  }

  std::string file_;
  std::vector<Level> levels_;
  std::optional<YamlNode> root_;
};

}  // namespace

YamlNode parse_yaml(const std::string& text, const std::string& file) {
  if (text.size() > kMostBytes) throw ScenarioError(file + ": larger than 1 MiB");
  // yaml-cpp overlooks a quote left open if a line break ends the file: the last
  // line is therefore a comment, which such a quote swallows.
  std::istringstream stream(text + "\n#");
  TreeBuilder builder(file);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    std::optional<YamlNode> root = builder.take_root();
    if (!root || root->kind == YamlNode::Kind::null) fail_at(file, 1, 1, "the file is empty");
    parser.HandleNextDocument(builder);
    if (const auto second = builder.take_root())
      fail_at(file, second->line, second->column, "a second document, allowed is one");
    return *std::move(root);
  } catch (const YAML::Exception& error) {
    fail_at(file, error.mark.line + 1, error.mark.column + 1,
            "not valid YAML: " + shown(error.msg));
  }
}

std::string read_scenario_text(const std::filesystem::path& path) {
  const std::string file = shown_file(path.string());
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw ScenarioError(file + ": no such file");
  if (!std::filesystem::is_regular_file(status))
    throw ScenarioError(file + ": " +
                        (std::filesystem::is_directory(status) ? "a directory" : "not a file") +
                        ", expected a scenario file");
  std::ifstream stream(path, std::ios::binary);
  std::string text(kMostBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream.is_open() || stream.bad()) throw ScenarioError(file + ": cannot be read");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace nightjar::scenarios
