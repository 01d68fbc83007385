#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/support/scratch_folder.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

bool appears(const fs::path& path, std::chrono::seconds within) {
  const auto end = std::chrono::steady_clock::now() + within;
  while (!fs::exists(path) && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return fs::exists(path);
}

TEST(InterruptTest, CtrlCEndsARunWith130AndWithoutResultsThatLookComplete) {
  const test::ScratchFolder scratch;
  const fs::path out = scratch / "out";
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    execl(NIGHTJAR_PROGRAM, "nightjar", "run",
          NIGHTJAR_SOURCE_DIR "/scenarios/tracking_landing.yaml", "--out", out.c_str(),
          "--no-video", "--quiet", nullptr);
    _exit(127);
  }
  // Written when the flight begins; it flies for longer than a minute.
  EXPECT_TRUE(appears(out / "scenario.yaml", std::chrono::seconds(60)));
  kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  for (const char* result : {"summary.json", "estimates.csv", "run.lcm", "run.mp4"})
    EXPECT_FALSE(fs::exists(out / result)) << result;
}

}  // namespace
}  // namespace nightjar::tools
