#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/scratch_folder.h"

namespace nightjar::test {

/// Runs the built program in a folder of the test's own, without a person to ask.
class ProgramTest : public testing::Test {
 protected:
  /// The exit code; what it said goes to `out` and `err`. `environment`: NAME=VALUE.
  int run_program(const std::string& arguments, const std::string& environment = "") {
    const std::string command = "cd '" + folder_.path().string() + "' && " + environment +
                                " '" NIGHTJAR_PROGRAM "' " + arguments +
                                " >out.log 2>err.log </dev/null";
    const int status = std::system(command.c_str());
    out = file_text(folder_ / "out.log");
    err = file_text(folder_ / "err.log");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  /// One line of complaint that holds `part`, and nothing else.
  void expect_one_line(const std::string& part) const {
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    EXPECT_TRUE(err.starts_with("nightjar: ") && err.ends_with("\n")) << err;
    EXPECT_NE(err.find(part), std::string::npos) << err;
    EXPECT_EQ(out, "");
  }

  ScratchFolder folder_;
  std::string out;
  std::string err;
};

/// Starts the built program and sends it SIGINT once `sign` exists, which only the program
/// makes; a test cannot know when, so it looks again and again, for a minute at most.
/// Returns the exit code, -1 when there is none.
inline int interrupt_when_there_is(const std::filesystem::path& sign,
                                   std::vector<std::string> arguments) {
  std::vector<char*> argv;
  arguments.insert(arguments.begin(), "nightjar");
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    execv(NIGHTJAR_PROGRAM, argv.data());
    _exit(127);
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!std::filesystem::exists(sign) && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(std::filesystem::exists(sign));
  kill(child, SIGINT);
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace nightjar::test
