#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

// Runs the built program on a flight of a fifth of a second, which ends before it lands
// and so with 1.
class RunCommandTest : public test::ProgramTest {
 protected:
  RunCommandTest() {
    std::ofstream(folder_ / "short.yaml")
        << "name: short\nduration_s: 0.2\nmodel: " NIGHTJAR_SOURCE_DIR "/models/arena.xml\n"
        << "world:\n  start_from_tag_m: [-0.1, 0.05, 0.9]\n  ugv:\n    course:\n"
        << "      - {x_m: -5.0, y_m: -3.0, speed_m_s: 0.3, phase: straight}\n"
        << "      - {x_m: 3.0, y_m: -3.0, speed_m_s: 0.3, phase: landing}\n";
  }

  int run(const std::string& arguments, const std::string& environment = "") {
    return run_program("run " + arguments, environment);
  }

  static bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }

  const std::string kShort = "short.yaml --out results --no-video ";
};

TEST_F(RunCommandTest, another_driver_of_mesas_is_refused_in_one_line) {
  EXPECT_EQ(run(kShort + "--quiet", "GALLIUM_DRIVER=softpipe"), 3) << err;
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
  EXPECT_TRUE(err.starts_with("nightjar: OSMesa ")) << err;
  EXPECT_TRUE(holds(err, "GALLIUM_DRIVER")) << err;
  EXPECT_EQ(out, "");
  EXPECT_FALSE(fs::exists(folder_ / "results/summary.json"));
}

TEST_F(RunCommandTest, profile_adds_the_stages_to_the_table) {
  EXPECT_EQ(run(kShort + "--profile"), 1) << err;
  const std::size_t profile = out.find("\nthread    stage ");
  ASSERT_NE(profile, std::string::npos) << out;
  EXPECT_TRUE(holds(out.substr(0, profile), "short")) << out;  // the summary's table
  for (const char* part : {"ms/call", "% of wall", "emulate pixels", "read out"})
    EXPECT_TRUE(holds(out.substr(profile), part)) << part << '\n' << out;
}

TEST_F(RunCommandTest, quiet_leaves_the_profile_alone_and_without_it_nothing) {
  EXPECT_EQ(run(kShort + "--quiet --profile"), 1) << err;
  EXPECT_TRUE(out.starts_with("thread    stage ")) << out;
  EXPECT_TRUE(holds(out, "emulate pixels")) << out;
  EXPECT_EQ(run(kShort + "--quiet"), 1) << err;
  EXPECT_EQ(out, "");
}

TEST_F(RunCommandTest, json_holds_the_profile_and_nothing_follows_it) {
  EXPECT_EQ(run(kShort + "--json --profile"), 1) << err;
  EXPECT_FALSE(nlohmann::json::parse(out)["profile"].empty());
}

TEST_F(RunCommandTest, help_says_what_profile_does_with_quiet_and_json) {
  EXPECT_EQ(run("--help"), 0);
  EXPECT_TRUE(holds(out, "also with --quiet")) << out;
}

}  // namespace
}  // namespace nightjar::tools
