#include "scenarios/yaml_writer.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/random.h"
#include "scenarios/yaml_reader.h"

namespace nightjar::scenarios {
namespace {

enum class Light { dim, bright };

constexpr core::Choices<Light, 2> kLights{{{"dim", Light::dim}, {"bright", Light::bright}}};

struct Step {
  double length_m = 1.5;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("length_m", length_m, -1e308, 1e308);
  }
};

struct Config {
  std::string name;
  int seed = 3;
  bool video = false;
  std::array<double, 2> wind_m_s = {0.1, -2};
  Light light = Light::bright;
  Step step;
  std::vector<Step> steps = {{2}, {1e-7}};

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("name", name);
    v.field("seed", seed, 0, 9);
    v.field("video", video);
    v.field("wind_m_s", wind_m_s, -10.0, 10.0);
    v.choice("light", light, kLights);
    v.section("step", step);
    v.list("steps", steps, 0, 5);
  }
};

Config named(const std::string& name) {
  Config config;
  config.name = name;
  return config;
}

Config read_back(const Config& config) {
  Config copy = named("other");
  read_yaml(to_yaml(config), "written.yaml", copy);
  return copy;
}

TEST(YamlWriterTest, WritesEveryValueWithItsRangeBesideIt) {
  EXPECT_EQ(to_yaml(named("night")),
            "name: \"night\"\n"
            "seed: 3  # 0 to 9\n"
            "video: false  # true, false\n"
            "wind_m_s: [0.1, -2]  # -10 to 10\n"
            "light: bright  # dim, bright\n"
            "step:\n"
            "  length_m: 1.5  # -1e+308 to 1e+308\n"
            "steps:\n"
            "  - length_m: 2  # -1e+308 to 1e+308\n"
            "  - length_m: 1e-07  # -1e+308 to 1e+308\n");
}

TEST(YamlWriterTest, WritesNumbersThatReadBackToTheSameBits) {
  core::Random random = core::random_stream(7, "yaml_writer_test");
  for (int i = 0; i < 2000; ++i) {
    const double value = std::bit_cast<double>(random());  // every exponent, denormals too
    if (!(std::abs(value) <= 1e308)) continue;
    Config config;
    config.step.length_m = value;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read_back(config).step.length_m),
              std::bit_cast<std::uint64_t>(value));
  }
}

TEST(YamlWriterTest, WritesTextThatReadsBackUnchanged) {
  for (const std::string name :
       {"", "~", "null", "true", "5", "a: b # c", "- x", "it's \"quoted\" \\ twice", "two\nlines",
        "tab\tand \x01 control \x7f", "Lichtstärke", " spaces ", "&a *b !c", "\u2028\u0085"})
    EXPECT_EQ(read_back(named(name)).name, name);
}

TEST(YamlWriterTest, WritesAnEmptyListAsAnEmptyList) {
  Config config;
  config.steps.clear();
  EXPECT_TRUE(read_back(config).steps.empty());
}

}  // namespace
}  // namespace nightjar::scenarios
