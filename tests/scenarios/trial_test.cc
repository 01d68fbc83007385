#include "scenarios/trial.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scenarios/trial_report.h"
#include "tests/support/sim_scene.h"

namespace nightjar::scenarios {
namespace {

TrialScore score(const std::string& method, sim::CarryMotion motion, double lux,
                 std::uint64_t seed) {
  return {method, motion, lux, seed, 10, 4, 1, 2, 1.2};
}

const std::vector<TrialScore> kScores = {score("a", sim::CarryMotion::hover, 2, 1),
                                         {"a", sim::CarryMotion::hover, 2, 2, 30, 26, 0, 3, 1.8},
                                         score("b", sim::CarryMotion::hover, 2, 1),
                                         score("a", sim::CarryMotion::slow, 2, 1),
                                         score("a", sim::CarryMotion::hover, 5, 1)};

TEST(Trial, cell_joins_the_seeds_of_one_method_motion_and_light) {
  const TrialCell cell = trial_cell(kScores, "a", sim::CarryMotion::hover, 2);
  EXPECT_DOUBLE_EQ(cell.detection_rate, 30.0 / 40);  // not the mean of 0.4 and 0.87
  EXPECT_DOUBLE_EQ(cell.ssim, 3.0 / 5);
  EXPECT_EQ(cell.false_detections, 1);
}

TEST(Trial, cell_of_nothing_is_zero) {
  const TrialCell cell = trial_cell(kScores, "c", sim::CarryMotion::hover, 2);
  EXPECT_EQ(cell.detection_rate, 0);
  EXPECT_EQ(cell.ssim, 0);
}

TEST(Trial, table_has_a_row_for_each_motion_and_light_and_one_of_means) {
  TrialConfig config;
  config.motions = {sim::CarryMotion::hover, sim::CarryMotion::slow};
  config.illuminances_lux = {2};
  const std::vector<TrialEntry> entries = {{"a", {}}, {"b", {}}};
  EXPECT_EQ(trial_table(config, entries, kScores),
            "detection rate in % / SSIM\n"
            "sequences         a              b\n"
            "hover 2 lux        75.0 / 0.600   40.0 / 0.600\n"
            "slow 2 lux         40.0 / 0.600    0.0 / 0.000\n"
            "mean               57.5 / 0.600   20.0 / 0.300\n"
            "false detections      2              1\n");
}

TEST(Trial, json_holds_every_score) {
  const auto list = nlohmann::json::parse(trial_json(kScores));
  ASSERT_EQ(list.size(), kScores.size());
  EXPECT_EQ(list[1]["method"], "a");
  EXPECT_EQ(list[1]["motion"], "hover");
  EXPECT_EQ(list[1]["illuminance_lux"], 2.0);
  EXPECT_EQ(list[1]["seed"], 2);
  EXPECT_EQ(list[1]["visible"], 30);
  EXPECT_EQ(list[1]["detected"], 26);
  EXPECT_EQ(list[1]["false_detections"], 0);
  EXPECT_DOUBLE_EQ(list[1]["ssim"].get<double>(), 0.6);
}

TrialConfig bright_and_slow() {
  TrialConfig config;
  config.model = test::arena();
  config.motions = {sim::CarryMotion::slow};
  config.illuminances_lux = {1000};
  config.seeds = {1};
  config.duration_s = 1.2;
  return config;
}

TEST(Trial, a_short_one_gives_plausible_scores_and_the_same_ones_again) {
  TrialConfig config = bright_and_slow();
  TrialEntry without{"without", {}};  // nothing adds up: all grey
  without.config.esi.decay_rate_hz = 1000;
  without.config.esi.decay_power = 20;
  const std::vector<TrialEntry> entries = {{"esi", {}}, without};
  std::vector<std::string> sequences;
  const auto scores = run_trial(config, entries, [&](int, int all, const std::string& sequence) {
    EXPECT_EQ(all, 1);
    sequences.push_back(sequence);
  });
  EXPECT_EQ(sequences, (std::vector<std::string>{"slow, 1000 lux, seed 1", ""}));
  ASSERT_EQ(scores.size(), 2u);
  EXPECT_EQ(scores[0].method, "esi");
  EXPECT_EQ(scores[1].method, "without");
  // Pictures every 10 ms, each fourth from 1 s to 1.2 s: 1.00, 1.04, ... 1.20.
  EXPECT_EQ(scores[0].visible, 6);
  EXPECT_EQ(scores[1].visible, 6);
  EXPECT_EQ(scores[0].compared, 2);  // each fifth of them
  EXPECT_GE(scores[0].detected, 5);  // a slow camera in good light
  EXPECT_EQ(scores[0].false_detections, 0);
  EXPECT_LT(scores[1].detected, scores[0].detected);
  EXPECT_GT(scores[0].ssim_sum, scores[1].ssim_sum);
  EXPECT_LT(scores[0].ssim_sum, 2.0);

  const auto again = run_trial(config, {entries[0]}, [](int, int, const std::string&) {});
  ASSERT_EQ(again.size(), 1u);  // whoever else takes part
  EXPECT_EQ(again[0].detected, scores[0].detected);
  EXPECT_EQ(again[0].ssim_sum, scores[0].ssim_sum);
}

TEST(Trial, frames_show_more_than_events_where_little_moves_in_bright_light) {
  TrialConfig config = bright_and_slow();
  config.motions = {sim::CarryMotion::hover};
  TrialEntry with{"with", {}}, without{"without", {}};
  with.config.method = without.config.method = esi::Method::esi_net;
  without.config.esi_net.use_frames = false;
  const auto scores = run_trial(config, {with, without}, [](int, int, const std::string&) {});
  // 0.92 and 0.55 on tuning seeds (docs/decisions/0009); half of what lies between.
  EXPECT_GT(scores[0].ssim_sum / scores[0].compared,
            scores[1].ssim_sum / scores[1].compared + 0.18);
  EXPECT_GE(scores[0].detected, scores[1].detected);
}

TEST(Trial, refuses_a_bad_config) {
  const auto refuses = [](auto change) {
    TrialConfig config = bright_and_slow();
    std::vector<TrialEntry> entries = {{"esi", {}}};
    change(config, entries);
    EXPECT_THROW(run_trial(config, entries, [](int, int, const std::string&) {}),
                 std::invalid_argument);
  };
  refuses([](auto& config, auto&) { config.duration_s = 1; });
  refuses([](auto& config, auto&) { config.score_every = 0; });
  refuses([](auto& config, auto&) { config.motions = {}; });
  refuses([](auto& config, auto&) { config.seeds = {}; });
  refuses([](auto&, auto& entries) { entries.clear(); });
  refuses([](auto& config, auto&) { config.model = "no_such.xml"; });
  refuses([](auto& config, auto&) { config.illuminances_lux = {0}; });
  refuses([](auto&, auto& entries) { entries[0].config.esi.decay_rate_hz = -1; });
}

}  // namespace
}  // namespace nightjar::scenarios
