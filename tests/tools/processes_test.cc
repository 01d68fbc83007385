#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"

// Every loop here runs in a network namespace of its own, with nothing but its loopback
// device: what is sent cannot leave it.
namespace nightjar::tools {
namespace {

constexpr const char* kNamespace = "unshare --user --map-root-user --net";
constexpr const char* kLoopback =
    "ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo";

bool may_make_a_network() {
  return std::system(fmt::format("{} sh -c '{}' >/dev/null 2>&1", kNamespace, kLoopback).c_str()) ==
         0;
}

class ProcessesTest : public test::ProgramTest {
 protected:
  void SetUp() override {
    if (!may_make_a_network())
      GTEST_SKIP() << "a network namespace with a multicast route is not permitted here";
    write_scenario("short", 0.3);
    write_scenario("long", 2.0);  // until the others have started, however busy the machine is
  }

  void write_scenario(const std::string& name, double duration_s) {
    std::ofstream(folder_ / (name + ".yaml"))
        << fmt::format("name: {}\nduration_s: {}\nmodel: {}/models/arena.xml\n", name, duration_s,
                       NIGHTJAR_SOURCE_DIR)
        << "world: {start_from_tag_m: [-0.1, 0.05, 0.9]}\n";
  }

  /// Runs `source` with the two others, which are stopped by a signal each when it is done;
  /// true when all ended as they should. Whatever happens, the namespace's first process
  /// takes all others with it. A process that has written its first line takes signals.
  /// `before` and `during`: shell lines to begin with, and for when all have been started.
  bool run_loop(const std::string& source, const std::string& before = "",
                const std::string& during = "") {
    std::ofstream(folder_ / "loop.sh")
        << kLoopback << " || exit 9\n"
        << before << "nightjar='" NIGHTJAR_PROGRAM "'\n"
        << "heard() { until [ -s $1 ] || ! kill -0 $2 2>/dev/null; do sleep 0.05; done; }\n"
        << "$nightjar reconstruct --lcm short.yaml --json >r.json 2>r.err & r=$!\n"
        << "timeout 100 $nightjar " << source << " --json >s.json 2>s.err & s=$!\n"
        << "sleep 0.3\n"  // the tracker comes late
        << "$nightjar track short.yaml --json >t.json 2>t.err & t=$!\n"
        << during << "wait $s; s=$?; heard t.err $t; heard r.err $r; kill -TERM $t; kill -INT $r\n"
        << "wait $t; t=$?; wait $r; r=$?; echo \"$s $t $r\" >codes\n";
    const std::string command =
        fmt::format("cd '{}' && {} --pid --fork --kill-child timeout 120 sh loop.sh",
                    folder_.path().string(), kNamespace);
    return std::system(command.c_str()) == 0 && test::file_text(folder_ / "codes") == "0 0 0\n";
  }

  nlohmann::json report(const std::string& file) {
    return nlohmann::json::parse(test::file_text(folder_ / file));
  }

  std::string errors() {
    return test::file_text(folder_ / "s.err") + test::file_text(folder_ / "r.err") +
           test::file_text(folder_ / "t.err");
  }
};

TEST_F(ProcessesTest, ThreeProcessesInLockStepEstimateTheBitsOfOneAndSoDoesAReplay) {
  ASSERT_EQ(run_program("run short.yaml --out one --no-video --record-events --quiet --json"), 1)
      << err;  // it has no time to land
  const std::string wanted = nlohmann::json::parse(out)["estimates_sha256"];
  for (const char* source : {"simulate short.yaml", "replay one/run.lcm --lockstep"}) {
    ASSERT_TRUE(run_loop(source)) << source << errors();
    EXPECT_EQ(report("t.json")["estimates_sha256"], wanted) << source;
    EXPECT_EQ(report("s.json")["steps"], 30) << source;  // 0.3 s, 100 a second
    EXPECT_EQ(report("t.json")["messages_refused"], 0) << source;
  }
}

TEST_F(ProcessesTest, FreeRunningALoopEndsAndReports) {
  ASSERT_TRUE(run_loop("simulate long.yaml --free-running")) << errors();
  for (const char* file : {"s.json", "r.json", "t.json"}) {
    const nlohmann::json report = this->report(file);
    for (const char* key : {"steps", "rate_hz", "latency_median_us", "latency_99_percent_us",
                            "latency_max_us", "messages_lost", "steps_lost"})
      EXPECT_TRUE(report.contains(key)) << file << ' ' << key;
  }
  EXPECT_GT(report("r.json")["steps"], 0);
}

TEST_F(ProcessesTest, DatagramsThatAreLostAreCountedAndSurvived) {
  // The source sends to a port of its own, and what the others hear has gaps.
  ASSERT_TRUE(
      run_loop("simulate long.yaml --free-running --lcm-url "
               "'udpm://239.255.76.67:7668?ttl=0'",
               "python3 " NIGHTJAR_SOURCE_DIR "/tests/support/lossy_relay.py 7668 7667 &\n"))
      << errors();
  const int sent = report("s.json")["steps"];
  for (const char* file : {"r.json", "t.json"}) {
    const nlohmann::json report = this->report(file);
    const int steps = report["steps"], lost = report["steps_lost"];
    EXPECT_GT(report["messages_lost"], 0) << file;
    EXPECT_GT(lost, 0) << file;
    EXPECT_GT(steps, lost) << file;  // 12 of 13 marks come through
    EXPECT_LE(steps + lost, sent) << file;
  }
  EXPECT_EQ(report("r.json")["messages_refused"], 0) << report("r.json")["first_refusal"];
}

TEST_F(ProcessesTest, AProcessThatDiesTakesNoOtherWithItAndANewOneFallsIn) {
  std::ofstream events(folder_ / "events.txt");
  for (int i = 1; i <= 5000; ++i) events << fmt::format("{:.3f} {} 9 1\n", 1e-3 * i, i % 346);
  events.close();
  // Dies as soon as it has told of steps.
  ASSERT_TRUE(run_loop("replay events.txt --size 346x260", "",
                       "until grep -q steps r.err || ! kill -0 $s; do sleep 0.05; done\n"
                       "kill -KILL $r\n"
                       "$nightjar reconstruct --lcm short.yaml --json >r.json 2>r.err & r=$!\n"))
      << errors();
  EXPECT_EQ(report("s.json")["steps"], 500);
  EXPECT_GT(report("r.json")["steps"], 0);  // the new one's
  EXPECT_LT(report("r.json")["steps"], 500);
}

TEST_F(ProcessesTest, BadInputIsOneLineAndExitCode2) {
  EXPECT_EQ(run_program("simulate none.yaml"), 2);
  expect_one_line("none.yaml");
  EXPECT_EQ(run_program("track none.yaml"), 2);
  expect_one_line("none.yaml");
  EXPECT_EQ(run_program("camera none.yaml"), 2);
  expect_one_line("none.yaml");
  EXPECT_EQ(run_program("camera short.yaml"), 2);
  expect_one_line("source.type = simulation, expected caer");
  EXPECT_EQ(run_program("replay none.aedat4"), 2);
  expect_one_line("none.aedat4");
  EXPECT_EQ(run_program("reconstruct --lcm"), 2);
  expect_one_line("SCENARIO");
  EXPECT_EQ(run_program("reconstruct --lcm short.yaml --out pictures"), 2);
  expect_one_line("--lcm");
  EXPECT_EQ(run_program("track short.yaml --lcm-url nosuch://"), 2);
}

}  // namespace
}  // namespace nightjar::tools
