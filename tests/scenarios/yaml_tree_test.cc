#include "scenarios/yaml_tree.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "scenarios/scenario_error.h"

namespace nightjar::scenarios {
namespace {

template <class Action>
std::string complaint(Action action) {
  try {
    action();
  } catch (const ScenarioError& error) {
    return error.what();
  }
  return "no complaint";
}

std::string parse_complaint(const std::string& text) {
  return complaint([&] { parse_yaml(text, "dark.yaml"); });
}

TEST(YamlTreeTest, RemembersTheOrderAndThePlaceOfEachKey) {
  const YamlNode root = parse_yaml("a: 1\nb:\n  c: 'two'\n  d: [3, 4]\n", "dark.yaml");
  ASSERT_EQ(root.kind, YamlNode::Kind::map);
  ASSERT_EQ(root.children.size(), 2u);
  const YamlNode& b = root.children[1];
  ASSERT_EQ(b.children.size(), 2u);
  EXPECT_EQ(b.key, "b");
  EXPECT_EQ(b.children[0].text, "two");
  EXPECT_TRUE(b.children[0].quoted);
  EXPECT_EQ(b.children[1].line, 4);
  EXPECT_EQ(b.children[1].column, 3);
  EXPECT_EQ(b.children[1].children[1].column, 10);
}

TEST(YamlTreeTest, RefusesTextWithoutADocument) {
  for (const char* text : {"", "\n\n", "# only a comment\n", "---\n", "~"})
    EXPECT_EQ(parse_complaint(text), "dark.yaml:1:1: the file is empty") << text;
}

TEST(YamlTreeTest, RefusesASecondDocument) {
  EXPECT_EQ(parse_complaint("a: 1\n---\nb: 2\n"),
            "dark.yaml:3:1: a second document, allowed is one");
}

TEST(YamlTreeTest, NamesThePlaceOfASyntaxError) {
  EXPECT_EQ(parse_complaint("a: [1, 2\nb: 3\n"),
            "dark.yaml:2:2: not valid YAML: end of sequence flow not found");
}

TEST(YamlTreeTest, RefusesAQuoteLeftOpenInsteadOfSwallowingTheRest) {
  for (const char* quote : {"'", "\""})
    for (const char* end : {"", "\n", "\n\n  \n", "\nb: 1\n", "\nb: 1"})
      EXPECT_NE(parse_complaint(std::string("a: ") + quote + "open" + end), "no complaint")
          << quote << end;
}

TEST(YamlTreeTest, LeavesAFilesLastLineAsItIs) {
  const auto last = [](const std::string& text) {
    return parse_yaml(text, "dark.yaml").children.back().text;
  };
  EXPECT_EQ(last("a: b"), "b");
  EXPECT_EQ(last("a: b # c"), "b");
  EXPECT_EQ(last("a: |\n  b\n"), "b\n");
  EXPECT_EQ(last("a: b\n...\n"), "b");
}

TEST(YamlTreeTest, RefusesAliasesSoThatNoneCanMultiply) {
  EXPECT_EQ(parse_complaint("a: &x [1]\nb: [*x, *x]\n"),
            "dark.yaml:1:4: anchors (&name) are not allowed");
}

TEST(YamlTreeTest, RefusesTagsAndKeysThatAreNotText) {
  EXPECT_EQ(parse_complaint("a: !!str 5\n"), "dark.yaml:1:4: tags (!name) are not allowed");
  EXPECT_EQ(parse_complaint("? [a]\n: 5\n"), "dark.yaml:1:3: a key has to be a name");
}

TEST(YamlTreeTest, RefusesDeepNestingInEveryStyle) {
  EXPECT_EQ(parse_complaint("a: " + std::string(100, '[') + std::string(100, ']')),
            "dark.yaml:1:35: nested deeper than 32 levels");
  for (const std::string piece : {"[", "{", "- ", "? ", "[{", "{? ", "- ? ", "!!a ", "&a "}) {
    std::string text;
    while (text.size() < 500000) text += piece;
    EXPECT_NE(parse_complaint(text), "no complaint") << piece;
  }
}

TEST(YamlTreeTest, RefusesMoreThanOneMebibyte) {
  EXPECT_EQ(parse_complaint("a: " + std::string(1 << 20, 'x')), "dark.yaml: larger than 1 MiB");
}

TEST(YamlTreeTest, SaysWhyAFileCannotBeRead) {
  const auto folder = std::filesystem::temp_directory_path();
  EXPECT_EQ(complaint([&] { read_scenario_text("nowhere/dark.yaml"); }),
            "nowhere/dark.yaml: no such file");
  EXPECT_EQ(complaint([&] { read_scenario_text(folder); }),
            folder.string() + ": a directory, expected a scenario file");
  EXPECT_EQ(complaint([&] { read_scenario_text("/dev/null"); }),
            "/dev/null: not a file, expected a scenario file");
}

TEST(YamlTreeTest, ReadsAWholeFile) {
  const auto path = std::filesystem::temp_directory_path() / "nightjar_yaml_tree_test.yaml";
  const std::string text("a: 1\r\n\0b", 8);
  std::ofstream(path, std::ios::binary) << text;
  EXPECT_EQ(read_scenario_text(path), text);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace nightjar::scenarios
