#include "scenarios/yaml_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace nightjar::scenarios {
namespace {

enum class Noise { none, dim };

constexpr core::Choices<Noise, 2> kNoises{{{"none", Noise::none}, {"dim", Noise::dim}}};

struct Pixel {
  double cutoff_hz = 300;
  int queue = 10;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("cutoff_hz", cutoff_hz, 0.0, 1000.0);
    v.field("queue", queue, 1, 100);
  }
};

struct Config {
  std::string name = "default";
  bool video = true;
  std::array<double, 3> wind_m_s = {0, 0, 0};
  Noise noise = Noise::none;
  Pixel pixel;
  std::vector<Pixel> pixels = {{1, 1}};

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("name", name);
    v.field("video", video);
    v.field("wind_m_s", wind_m_s, -10.0, 10.0);
    v.choice("noise", noise, kNoises);
    v.section("pixel", pixel);
    v.list("pixels", pixels, 1, 3);
  }
};

Config read(const std::string& text) {
  Config config;
  read_yaml(text, "dark.yaml", config);
  return config;
}

std::string complaint(const std::string& text) {
  try {
    read(text);
  } catch (const ScenarioError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(YamlReaderTest, FillsEveryKindOfMember) {
  const Config config = read(
      "name: fast\nvideo: false\nwind_m_s: [1, -2.5, 1e-3]\nnoise: dim\n"
      "pixel: {cutoff_hz: +20, queue: 7}\npixels:\n  - cutoff_hz: 2\n  - queue: 3\n");
  EXPECT_EQ(config.name, "fast");
  EXPECT_FALSE(config.video);
  EXPECT_THAT(config.wind_m_s, testing::ElementsAre(1, -2.5, 1e-3));
  EXPECT_EQ(config.noise, Noise::dim);
  EXPECT_EQ(config.pixel.cutoff_hz, 20);
  EXPECT_EQ(config.pixel.queue, 7);
  ASSERT_EQ(config.pixels.size(), 2u);
  EXPECT_EQ(config.pixels[0].cutoff_hz, 2);
  EXPECT_EQ(config.pixels[0].queue, 10);  // an element's absent key keeps its default
  EXPECT_EQ(config.pixels[1].queue, 3);
}

TEST(YamlReaderTest, KeepsDefaultsOfAbsentKeys) {
  const Config config = read("video: false\n");
  EXPECT_EQ(config.name, "default");
  EXPECT_EQ(config.pixel.cutoff_hz, 300);
  EXPECT_EQ(config.pixels.size(), 1u);
}

TEST(YamlReaderTest, TakesBothEndsOfARange) {
  EXPECT_EQ(read("pixel: {cutoff_hz: 0, queue: 1}").pixel.cutoff_hz, 0);
  EXPECT_EQ(read("pixel: {cutoff_hz: 1000, queue: 100}").pixel.queue, 100);
}

TEST(YamlReaderTest, TakesQuotedTextForTextOnly) {
  EXPECT_EQ(read("name: '5'").name, "5");
  EXPECT_EQ(complaint("pixel:\n  queue: '5'"),
            "dark.yaml:2:3: pixel.queue = \"5\", expected a whole number from 1 to 100");
}

struct Case {
  const char* name;
  const char* text;
  const char* complaint;
};

class YamlReaderComplaint : public testing::TestWithParam<Case> {};

TEST_P(YamlReaderComplaint, NamesThePlaceTheKeyAndWhatIsAllowed) {
  EXPECT_EQ(complaint(GetParam().text), GetParam().complaint);
}

constexpr Case kCases[] = {
    {"BelowRange", "name: a\npixel:\n  cutoff_hz: -1\n",
     "dark.yaml:3:3: pixel.cutoff_hz = -1, allowed 0 to 1000"},
    {"BarelyAboveRange", "pixel: {cutoff_hz: 1000.0000000001}",
     "dark.yaml:1:9: pixel.cutoff_hz = 1000.0000000001, allowed 0 to 1000"},
    {"IntOutOfRange", "pixel:\n  queue: 101", "dark.yaml:2:3: pixel.queue = 101, allowed 1 to 100"},
    {"IntBeyondItsType", "pixel:\n  queue: 4294967298",
     "dark.yaml:2:3: pixel.queue = 4294967298, allowed 1 to 100"},
    {"TextForANumber", "pixel:\n  cutoff_hz: fast\n",
     "dark.yaml:2:3: pixel.cutoff_hz = fast, expected a number from 0 to 1000"},
    {"NumberWithItsUnit", "pixel:\n  cutoff_hz: 20 Hz\n",
     "dark.yaml:2:3: pixel.cutoff_hz = 20 Hz, expected a number from 0 to 1000"},
    {"FractionForAnInt", "pixel:\n  queue: 1.5\n",
     "dark.yaml:2:3: pixel.queue = 1.5, expected a whole number from 1 to 100"},
    {"NotANumber", "pixel:\n  cutoff_hz: .nan\n",
     "dark.yaml:2:3: pixel.cutoff_hz = .nan, expected a number from 0 to 1000"},
    {"NotANumberInC", "pixel:\n  cutoff_hz: nan\n",
     "dark.yaml:2:3: pixel.cutoff_hz = nan, expected a number from 0 to 1000"},
    {"Infinity", "pixel:\n  cutoff_hz: inf\n",
     "dark.yaml:2:3: pixel.cutoff_hz = inf, expected a number from 0 to 1000"},
    {"MoreThanADouble", "pixel:\n  cutoff_hz: 1e999\n",
     "dark.yaml:2:3: pixel.cutoff_hz = 1e999, expected a number from 0 to 1000"},
    {"NothingForANumber", "pixel:\n  cutoff_hz:\n",
     "dark.yaml:2:3: pixel.cutoff_hz = nothing, expected a number from 0 to 1000"},
    {"ListForANumber", "pixel:\n  cutoff_hz: [1]\n",
     "dark.yaml:2:3: pixel.cutoff_hz = a list, expected a number from 0 to 1000"},
    {"YesForABool", "video: yes", "dark.yaml:1:1: video = yes, expected true or false"},
    {"SectionForText", "name: {a: 1}", "dark.yaml:1:1: name = a section, expected text"},
    {"NumberForASection", "pixel: 5", "dark.yaml:1:1: pixel = 5, expected a section"},
    {"NothingForASection", "pixel:\nname: a", "dark.yaml:1:1: pixel = nothing, expected a section"},
    {"UnknownChoice", "noise: dimm", "dark.yaml:1:1: noise = dimm, allowed: none, dim"},
    {"ShortList", "wind_m_s: [1, 2]", "dark.yaml:1:1: wind_m_s: a list of 2, expected 3 numbers"},
    {"NumberForAList", "wind_m_s: 1", "dark.yaml:1:1: wind_m_s = 1, expected a list of 3 numbers"},
    {"ElementOutOfRange", "wind_m_s:\n  - 1\n  - 11\n  - 0",
     "dark.yaml:3:5: wind_m_s[1] = 11, allowed -10 to 10"},
    {"TooManySections", "pixels: [{}, {}, {}, {}]",
     "dark.yaml:1:1: pixels.size = 4, allowed 1 to 3"},
    {"SectionForAListOfThem", "pixels: {}", "dark.yaml:1:1: pixels = a section, expected a list"},
    {"MemberOfAListOutOfRange", "pixels:\n  - queue: 1\n  - queue: 0",
     "dark.yaml:3:5: pixels[1].queue = 0, allowed 1 to 100"},
    {"UnknownKey", "pixel:\n  queue: 5\n  cutof_hz: 3\n",
     "dark.yaml:3:3: pixel.cutof_hz: unknown key, nearest is cutoff_hz; "
     "allowed: cutoff_hz, queue"},
    {"UnknownSection", "pixelz: []\n",
     "dark.yaml:1:1: pixelz: unknown key, nearest is pixel; "
     "allowed: name, video, wind_m_s, noise, pixel, pixels"},
    {"KeyWithoutItsUnit", "pixel:\n  cutoff: 3\n",
     "dark.yaml:2:3: pixel.cutoff: unknown key, nearest is cutoff_hz; "
     "allowed: cutoff_hz, queue"},
    {"DuplicateKey", "pixel:\n  queue: 5\n  queue: 6\n",
     "dark.yaml:3:3: pixel.queue: duplicate key, first on line 2"},
    {"DuplicateSection", "pixel: {queue: 5}\nname: a\npixel: {queue: 5}\n",
     "dark.yaml:3:1: pixel: duplicate key, first on line 1"},
    {"NotAMapping", "- 1\n- 2\n", "dark.yaml:1:1: expected `name: value` lines"},
    {"OnlyText", "hello", "dark.yaml:1:1: expected `name: value` lines"},
};

INSTANTIATE_TEST_SUITE_P(Each, YamlReaderComplaint, testing::ValuesIn(kCases),
                         [](const auto& each) { return each.param.name; });

TEST(YamlReaderTest, KeepsAnyComplaintToOneShortLine) {
  const std::string text = complaint("? \"a\\n" + std::string(5000, 'x') + "\"\n: 1\n");
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_LT(text.size(), 300u);
}

}  // namespace
}  // namespace nightjar::scenarios
