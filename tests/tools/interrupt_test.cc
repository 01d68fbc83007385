#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/program.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

TEST(InterruptTest, CtrlCEndsARunWith130AndWithoutResultsThatLookComplete) {
  const test::ScratchFolder scratch;
  const fs::path out = scratch / "out";
  // The scenario is written when the flight begins, which takes longer than a moment.
  EXPECT_EQ(
      test::interrupt_when_there_is(out / "scenario.yaml",
                                    {"run", NIGHTJAR_SOURCE_DIR "/scenarios/tracking_landing.yaml",
                                     "--out", out.string(), "--no-video", "--quiet"}),
      130);
  for (const char* result : {"summary.json", "estimates.csv", "run.lcm", "run.mp4"})
    EXPECT_FALSE(fs::exists(out / result)) << result;
}

}  // namespace
}  // namespace nightjar::tools
