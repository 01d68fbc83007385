#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/rules_include_checker.h"

namespace nightjar::rules {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

// A tree of sources made for one test.
class IncludeCheckerTest : public testing::Test {
 protected:
  ~IncludeCheckerTest() override { fs::remove_all(root_); }

  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }

  // The violations of a tree with this one include, without their places.
  std::vector<std::string> check(const std::string& file, const std::string& path) const {
    write(file, "#include <" + path + ">\n");
    std::vector<std::string> reasons;
    for (const std::string& each : violations(read_includes(root_)))
      reasons.push_back(each.substr(each.rfind(": ") + 2));
    fs::remove(root_ / file);
    return reasons;
  }

  fs::path root_ = fs::temp_directory_path() / ("nightjar_rules_" + std::to_string(getpid()));
};

TEST(IncludeRuleTest, EverySourceIncludesOnlyWhatItsFolderMay) {
  const auto includes = read_includes(NIGHTJAR_SOURCE_DIR);
  ASSERT_GT(includes.size(), 50u);  // the sources were found at all
  EXPECT_THAT(violations(includes), IsEmpty());
}

TEST(IncludeRuleTest, NoNodeUnderTestListensToTheTruth) {
  for (const char* node : {"tracker_node.cc", "reconstruction_node.cc"})  // there to be checked
    EXPECT_TRUE(fs::exists(fs::path(NIGHTJAR_SOURCE_DIR) / "scenarios" / node)) << node;
  EXPECT_THAT(truth_listeners(NIGHTJAR_SOURCE_DIR), IsEmpty());
}

TEST_F(IncludeCheckerTest, NamesTheFileAndTheLine) {
  write("core/event.h", "#pragma once\n\n#include <vector>\n  # include \"msg/bus.h\"  // why\n");
  EXPECT_THAT(violations(read_includes(root_)),
              ElementsAre("core/event.h:4: includes msg/bus.h: core may not see msg"));
}

TEST_F(IncludeCheckerTest, KeepsTheFiveModulesApart) {
  const std::vector<std::string> five = {"msg", "sim", "camera", "esi", "tracker"};
  for (const std::string& from : five)
    for (const std::string& to : five) {
      if (from == to) continue;
      EXPECT_THAT(check(from + "/a.cc", to + "/b.h"), ElementsAre(from + " may not see " + to));
    }
}

TEST_F(IncludeCheckerTest, LetsNobodySeeWhatStandsAboveIt) {
  for (const std::string folder : {"core", "msg", "sim", "camera", "esi", "tracker"}) {
    EXPECT_THAT(check(folder + "/a.cc", "scenarios/loop.h"),
                ElementsAre(folder + " may not see scenarios"));
    EXPECT_THAT(check(folder + "/a.cc", "tools/run_command.h"),
                ElementsAre(folder + " may not see tools"));
  }
  EXPECT_THAT(check("core/a.h", "esi/b.h"), ElementsAre("core may not see esi"));
  EXPECT_THAT(check("scenarios/a.cc", "tools/b.h"), ElementsAre("scenarios may not see tools"));
}

TEST_F(IncludeCheckerTest, KeepsEachLibraryInItsFolder) {
  EXPECT_THAT(check("tools/a.cc", "mujoco/mujoco.h"), ElementsAre("only sim may see mujoco"));
  EXPECT_THAT(check("scenarios/a.cc", "GL/osmesa.h"), ElementsAre("only sim may see GL"));
  EXPECT_THAT(check("sim/a.cc", "libcaer/libcaer.h"), ElementsAre("only camera may see libcaer"));
  EXPECT_THAT(check("sim/a.cc", "libcaercpp/libcaer.hpp"),
              ElementsAre("only camera may see libcaercpp"));
  EXPECT_THAT(check("scenarios/a.cc", "apriltag/apriltag.h"),
              ElementsAre("only tracker may see apriltag"));
  EXPECT_THAT(check("sim/a.cc", "tag36h11.h"), ElementsAre("only tracker may see apriltag"));
  EXPECT_THAT(check("scenarios/a.cc", "lcm/lcm-cpp.hpp"), ElementsAre("only msg may see lcm"));
  EXPECT_THAT(check("tracker/a.cc", "nightjar_lcm/picture_t.hpp"),
              ElementsAre("only msg may see nightjar_lcm"));
  EXPECT_THAT(check("tools/a.cc", "yaml-cpp/yaml.h"),
              ElementsAre("only scenarios may see yaml-cpp"));
}

TEST_F(IncludeCheckerTest, KeepsOpenCvOutOfTheReconstructionsButForTheNetworks) {
  const std::string reason = "of esi only esi/recurrent_network.cc may see opencv2";
  EXPECT_THAT(check("esi/esi.cc", "opencv2/core.hpp"), ElementsAre(reason));
  EXPECT_THAT(check("esi/make_network.cc", "opencv2/dnn.hpp"), ElementsAre(reason));
  EXPECT_THAT(check("esi/recurrent_network.cc", "opencv2/dnn.hpp"), IsEmpty());
  EXPECT_THAT(check("tracker/tag_detector.cc", "opencv2/core.hpp"), IsEmpty());
}

TEST_F(IncludeCheckerTest, KeepsTheInstalledReconstructionsFromTheNetworks) {
  for (const std::string file :
       {"esi/recurrent_network.h", "esi/make_network.h", "esi/onnx_signature.h"}) {
    EXPECT_THAT(check("esi/esi.cc", file),
                ElementsAre("only the networks and those who use esi may see " + file));
    EXPECT_THAT(check("esi/make_network.cc", file), IsEmpty());
    EXPECT_THAT(check("scenarios/a.cc", file), IsEmpty());
  }
}

TEST_F(IncludeCheckerTest, KeepsExternalHeadersOutOfPublicOnes) {
  const std::string reason = "a public header sees no external header";
  EXPECT_THAT(check("scenarios/a.h", "yaml-cpp/yaml.h"), ElementsAre(reason));
  EXPECT_THAT(check("sim/a.h", "mujoco/mujoco.h"), ElementsAre(reason));
  EXPECT_THAT(check("msg/a.h", "lcm/lcm-cpp.hpp"), ElementsAre(reason));
  EXPECT_THAT(check("tracker/a.h", "opencv2/core.hpp"), ElementsAre(reason));
  EXPECT_THAT(check("core/a.h", "unistd.h"), ElementsAre(reason));
}

TEST_F(IncludeCheckerTest, KeepsConfigHeadersFreeOfEverythingButCore) {
  EXPECT_THAT(check("esi/config.h", "Eigen/Core"),
              ElementsAre("a config header sees no external header"));
  EXPECT_THAT(check("sim/sensor_config.h", "sim/scene.h"),
              ElementsAre("a config header sees core and its folder's configs only"));
  EXPECT_THAT(check("sim/config.h", "sim/sensor_config.h"), IsEmpty());
}

TEST_F(IncludeCheckerTest, KeepsTruthFromTheLoopUnderTestHoweverFarAway) {
  write("core/plot.h", "#include \"core/truth.h\"\n");
  write("core/score.h", "#include \"core/plot.h\"\n#include \"core/score.h\"\n");
  EXPECT_THAT(check("esi/a.h", "core/truth.h"), ElementsAre("esi may not reach core/truth.h"));
  EXPECT_THAT(check("tracker/a.cc", "core/score.h"),
              ElementsAre("tracker may not reach core/truth.h"));
  EXPECT_THAT(check("sim/a.cc", "core/score.h"), IsEmpty());
}

TEST_F(IncludeCheckerTest, KeepsTruthFromTheNodesUnderTest) {
  const std::string reason = "a node under test may not see core/truth.h";
  write("msg/channels.h", "#include \"core/truth.h\"\n");
  for (const std::string file :
       {"scenarios/tracker_node.h", "scenarios/tracker_node.cc", "scenarios/reconstruction_node.h",
        "scenarios/reconstruction_node.cc"}) {
    EXPECT_THAT(check(file, "core/truth.h"), ElementsAre(reason));
    EXPECT_THAT(check(file, "msg/channels.h"), IsEmpty());  // all channels are declared there
  }
  EXPECT_THAT(check("scenarios/record_node.cc", "core/truth.h"), IsEmpty());
}

TEST_F(IncludeCheckerTest, FindsTheNodesUnderTestThatListenToTheTruth) {
  const std::string listens = "\nbus.subscribe(msg::kTruth, take);\n";
  write("scenarios/record_node.cc", listens);
  write("scenarios/tracker_node.h", "int kTruthful, notkTruth;\n");
  EXPECT_THAT(truth_listeners(root_), IsEmpty());
  write("scenarios/tracker_node.cc", listens);
  write("scenarios/reconstruction_node.h", listens);
  const std::string what = ":2: names kTruth: a node under test may not";
  EXPECT_THAT(truth_listeners(root_), ElementsAre("scenarios/reconstruction_node.h" + what,
                                                  "scenarios/tracker_node.cc" + what));
}

TEST_F(IncludeCheckerTest, TakesWhatTheRulesAllow) {
  EXPECT_THAT(check("core/a.h", "Eigen/Geometry"), IsEmpty());
  EXPECT_THAT(check("sim/a.cc", "mujoco/mujoco.h"), IsEmpty());
  EXPECT_THAT(check("scenarios/a.cc", "yaml-cpp/parser.h"), IsEmpty());
  EXPECT_THAT(check("scenarios/a.h", "tracker/config.h"), IsEmpty());
  EXPECT_THAT(check("tools/a.cc", "CLI/CLI.hpp"), IsEmpty());
  EXPECT_THAT(check("tools/a.cc", "unistd.h"), IsEmpty());
  EXPECT_THAT(check("msg/a.h", "nightjar_lcm/picture_t.hpp"), IsEmpty());
}

}  // namespace
}  // namespace nightjar::rules
