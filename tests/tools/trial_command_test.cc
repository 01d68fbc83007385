#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/program.h"
#include "tests/support/sim_scene.h"

namespace nightjar::tools {
namespace {

class TrialCommandTest : public test::ProgramTest {
 protected:
  int run(const std::string& arguments) {
    return run_program("trial '" + test::arena().string() + "' " + arguments);
  }

  void expect_refused(const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run(arguments), 2) << arguments << '\n' << err;
    expect_one_line(part);
  }
};

TEST_F(TrialCommandTest, prints_every_score_as_json) {
  ASSERT_EQ(run("--method accumulator --motion slow --illuminance 1000 --seed 3 --duration 1.1 "
                "--json"),
            0)
      << err;
  EXPECT_EQ(err, "");
  const auto scores = nlohmann::json::parse(out);
  ASSERT_EQ(scores.size(), 1u);
  EXPECT_EQ(scores[0]["method"], "accumulator");
  EXPECT_EQ(scores[0]["motion"], "slow");
  EXPECT_EQ(scores[0]["illuminance_lux"], 1000.0);
  EXPECT_EQ(scores[0]["seed"], 3);
}

TEST_F(TrialCommandTest, refuses_what_it_does_not_know_in_one_line) {
  expect_refused("--method nothing", "--method = nothing, allowed esi, accumulator");
  expect_refused("--method esi --method esi", "--method = esi, allowed once");
  expect_refused("--motion slow --motion fast --motion slow", "--motion = slow, allowed once");
  expect_refused("--seed 3 --seed 3", "--seed = 3, allowed once");
  expect_refused("--illuminance 5 --illuminance 5", "--illuminance = 5, allowed once");
  expect_refused("--motion dance", "--motion = dance, allowed hover, slow, fast, shake");
  expect_refused("--illuminance 0", "--illuminance");
  expect_refused("--seed -1", "--seed");
  expect_refused("--set reconstructor.esi.nothing=1", "nothing");
}

TEST_F(TrialCommandTest, refuses_what_is_out_of_range_in_one_line) {
  expect_refused("--duration 0", "duration_s = 0, allowed 1.1 to 600");
  expect_refused("--duration nan", "duration_s = nan, allowed 1.1 to 600");
  expect_refused("--score-every 0", "score_every = 0, allowed 1 to 1000");
  expect_refused("--set reconstructor.esi.decay_rate_hz=-1", "decay_rate_hz = -1");
}

TEST_F(TrialCommandTest, refuses_a_model_that_is_not_there) {
  EXPECT_EQ(run_program("trial no_such.xml"), 2);
  expect_one_line("no_such.xml");
}

}  // namespace
}  // namespace nightjar::tools
