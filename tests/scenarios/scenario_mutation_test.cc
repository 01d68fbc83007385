#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "core/random.h"
#include "scenarios/scenario.h"
#include "scenarios/yaml_writer.h"

namespace nightjar::scenarios {
namespace {

const std::filesystem::path kFile =
    std::filesystem::path(NIGHTJAR_SOURCE_DIR) / "scenarios" / "tracking_landing.yaml";

std::string shipped_text() {
  std::ifstream stream(kFile);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::size_t below(core::Random& random, std::size_t end) {
  return static_cast<std::size_t>(core::uniform01(random) * static_cast<double>(end));
}

constexpr std::array<std::string_view, 20> kPieces = {
    "[",     "{",   "- ",      ": ",     "\n",
    "  ",    "&a ", "*a",      "!!str ", "---\n",
    "? ",    "|\n", "\"",      "'",      ".nan",
    "1e999", "-0",  "%YAML 9", "\t",     std::string_view("\0", 1)};

// Changes, cuts, repeats or enriches the text in one place.
void mutate(std::string& text, core::Random& random) {
  const std::size_t at = below(random, text.size() + 1);
  const std::size_t length = below(random, 1 + std::min<std::size_t>(40, text.size() - at));
  switch (below(random, 4)) {
    case 0:
      if (at < text.size()) text[at] = static_cast<char>(below(random, 256));
      break;
    case 1: text.erase(at, length); break;
    case 2: text.insert(below(random, text.size() + 1), text.substr(at, length)); break;
    default: text.insert(at, kPieces[below(random, kPieces.size())]);
  }
}

// Any other exception, and any crash, fails the test.
TEST(ScenarioMutationTest, EveryDamagedTextIsReadAsSavedOrRefusedInOneLine) {
  const std::string shipped = shipped_text();
  core::Random random = core::random_stream(20240501, "scenario_mutation_test");
  int refused = 0;
  constexpr int kTexts = 4000;
  for (int i = 0; i < kTexts; ++i) {
    std::string text = shipped;
    for (std::size_t n = 1 + below(random, 4); n > 0; --n) mutate(text, random);
    try {
      Scenario scenario = parse(text, kFile);
      const std::string written = to_yaml(scenario);
      scenario.model = "../models/arena.xml";
      EXPECT_EQ(to_yaml(parse(to_yaml(scenario), kFile)), written);
    } catch (const ScenarioError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      ++refused;
    }
  }
  // Comments, names and digits may change harmlessly; most else may not.
  EXPECT_GT(refused, kTexts / 4);
  EXPECT_LT(refused, kTexts);
}

}  // namespace
}  // namespace nightjar::scenarios
