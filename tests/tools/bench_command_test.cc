#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.h"

namespace nightjar::tools {
namespace {

namespace fs = std::filesystem;

/// On a recording of a few events, for the made-up ones take seconds.
class BenchCommandTest : public test::ProgramTest {
 protected:
  BenchCommandTest() {
    std::ofstream events(folder_ / "events.txt");
    for (int i = 100; i < 1000; ++i)
      events << "0." << i << ' ' << i % 16 << ' ' << i % 12 << ' ' << i % 2 << '\n';
  }

  void expect_refused(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run_program("bench " + arguments), 2) << err;
    expect_one_line(part);
    EXPECT_FALSE(fs::exists(folder_ / "times.png"));
    EXPECT_FALSE(fs::exists(folder_ / "times.part.png"));
  }
};

TEST_F(BenchCommandTest, prints_a_table_of_the_methods) {
  ASSERT_EQ(run_program("bench events.txt --method esi --method accumulator"), 0) << err;
  EXPECT_EQ(err, "");
  for (const char* part : {"events.txt", "x reference", "of bound", "\n  esi ",
                           "\n  esi, 16-byte events ", "\n  accumulator ", "\n  bound "})
    EXPECT_NE(out.find(part), std::string::npos) << part << '\n' << out;
}

TEST_F(BenchCommandTest, measures_every_method_but_the_networks_by_default) {
  ASSERT_EQ(run_program("bench events.txt --size 16x12 --json"), 0) << err;
  std::string names;
  const auto json = nlohmann::json::parse(out);
  for (const auto& m : json["workloads"][0]["methods"])
    names += m["method"].get<std::string>() + ';';
  for (const char* name :
       {";esi;", ";accumulator;", ";complementary_filter;", ";edi;", ";fedi;", ";htac;", ";bound;"})
    EXPECT_NE(names.find(name), std::string::npos) << name << names;
  EXPECT_EQ(names.find("firenet"), std::string::npos);
}

TEST_F(BenchCommandTest, draws_the_time_of_a_picture) {
  ASSERT_EQ(run_program("bench events.txt --method esi --plot times.png"), 0) << err;
  EXPECT_EQ(test::file_text(folder_ / "times.png").substr(1, 3), "PNG");
  EXPECT_NE(out.find("ms a picture"), std::string::npos) << out;
}

TEST_F(BenchCommandTest, refuses_what_cannot_be) {
  expect_refused("none.txt", "none.txt");
  expect_refused("events.txt --method magic", "--method = magic, allowed esi, ");
  expect_refused("events.txt --method firenet", "weights");
  expect_refused("events.txt --size 16", "--size");
  expect_refused("--size 16x12", "--size");
  expect_refused("events.txt --plot times.jpg", "times.jpg");
  expect_refused("events.txt --plot none/times.png", "none/times.png");
  expect_refused("events.txt --method esi --set reconstructor.esi.decay_power=-1", "decay_power");
  std::ofstream(folder_ / "empty.txt") << "# nothing\n";
  expect_refused("empty.txt", "empty.txt");
}

TEST_F(BenchCommandTest, warns_of_events_it_has_to_leave_out) {
  ASSERT_EQ(run_program("bench events.txt --size 8x8 --method esi"), 0) << err;
  EXPECT_TRUE(err.starts_with("nightjar: warning: ")) << err;
  EXPECT_NE(err.find("events.txt"), std::string::npos) << err;
}

TEST_F(BenchCommandTest, its_help_tells_the_exit_codes) {
  EXPECT_EQ(run_program("bench --help"), 0);
  EXPECT_NE(out.find("Exit codes: 0 done, 2 bad input, 3 "), std::string::npos);
}

}  // namespace
}  // namespace nightjar::tools
