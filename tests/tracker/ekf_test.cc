#include "tracker/ekf.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "core/random.h"
#include "tracker/angles.h"

namespace nightjar::tracker {
namespace {

using core::Time;

constexpr double kPi = std::numbers::pi;
constexpr Time kPicture = std::chrono::milliseconds(10);

TargetState state(double x, double y, double z, double heading, double speed, double turn) {
  TargetState s;
  s << x, y, z, heading, speed, turn;
  return s;
}

TagFix fix_at(Time t, const TargetState& truth, double sigma_m = 0.01, double sigma_rad = 0.02) {
  TagFix fix{.t = t, .z = truth.head<4>(), .R = Eigen::Matrix4d::Identity()};
  fix.R *= sigma_m * sigma_m;
  fix.R(3, 3) = sigma_rad * sigma_rad;
  return fix;
}

TagFix noisy(TagFix fix, core::Random& random) {
  for (int i = 0; i < 4; ++i) fix.z[i] += std::sqrt(fix.R(i, i)) * core::normal(random);
  fix.z[3] = wrapped(fix.z[3]);
  return fix;
}

FixResult update(TargetEkf& ekf, const TagFix& fix) { return ekf.update(std::array{fix}); }

/// A filter that has followed `truth` exactly for 2 s, ending at `truth`'s time 2 s.
TargetEkf settled(TargetState truth, const FilterConfig& config = {}) {
  TargetEkf ekf(config);
  for (Time t{}; t <= std::chrono::seconds(2); t += kPicture) {
    update(ekf, fix_at(t, truth));
    truth = ctrv_predict(truth, core::seconds(kPicture));
  }
  return ekf;
}

TEST(Ctrv, DrivesACircleBackToItsStart) {
  const TargetState start = state(1, 2, 0.3, 0.7, 0.5, 0.6);
  const TargetState half = ctrv_predict(start, kPi / 0.6);
  EXPECT_NEAR((half - start).head<2>().norm(), 2 * 0.5 / 0.6, 1e-12);  // the diameter
  const TargetState end = ctrv_predict(start, 2 * kPi / 0.6);
  EXPECT_LT((end - start).norm(), 1e-12);  // rounding
}

TEST(Ctrv, DrivesStraightAndBackwards) {
  const TargetState end = ctrv_predict(state(1, 2, 0.3, kPi / 2, -0.5, 0), 2);
  EXPECT_LT((end - state(1, 1, 0.3, kPi / 2, -0.5, 0)).norm(), 1e-12);
}

TEST(Ctrv, HasNoStepWhereTheTurnRateVanishes) {
  for (const double turn : {1e-12, 1e-9, 1e-6, 1e-4, 1.999e-4, 2.001e-4, 1e-3}) {
    const TargetState bent = ctrv_predict(state(0, 0, 0, 0, 0.5, turn), 1);
    // Chord of an arc to third order; the next term is turn^4.
    EXPECT_NEAR(bent[0], 0.5 * (1 - turn * turn / 6), 1e-12);
    EXPECT_NEAR(bent[1], 0.5 * (turn / 2 - turn * turn * turn / 24), 1e-12);
  }
}

TEST(Ctrv, HasTheJacobianThatDifferencesGive) {
  for (const double turn : {0.0, 1e-9, 1e-5, 0.3, -0.6})
    for (const double dt_s : {0.01, 0.5}) {
      const TargetState x = state(1, -2, 0.1, 2.9, -0.4, turn);
      const TargetCovariance F = ctrv_jacobian(x, dt_s);
      constexpr double kStep = 1e-6;
      for (int i = 0; i < 6; ++i) {
        const TargetState d = kStep * TargetState::Unit(i);
        TargetState slope = ctrv_predict(x + d, dt_s) - ctrv_predict(x - d, dt_s);
        slope[3] = wrapped(slope[3]);
        slope /= 2 * kStep;
        // Rounding of 1e-16 over the step, times the state's size.
        EXPECT_LT((F.col(i) - slope).norm(), 1e-8) << "column " << i << ", turn rate " << turn;
      }
    }
}

TEST(Ctrv, AddsTheSameNoiseInOneStepAsInTwo) {
  const FilterConfig config;
  const TargetState x = state(0, 0, 0, 0.4, 0, 0);  // standing: F is exact
  const TargetCovariance F = ctrv_jacobian(x, 0.1);
  const TargetCovariance half = ctrv_process_noise(0.4, 0.1, config);
  const TargetCovariance two = F * half * F.transpose() + half;
  EXPECT_LT((two - ctrv_process_noise(0.4, 0.2, config)).norm(), 1e-12);
}

TEST(TargetEkf, LearnsSpeedAndTurnRateFromPositionAndHeadingAlone) {
  const TargetEkf ekf = settled(state(0, 0, 0.2, 3, 0.5, 0.6));
  // Exact fixes: what is left is the start's forgotten share, far below a sigma.
  EXPECT_NEAR(ekf.state()[4], 0.5, 0.01);
  EXPECT_NEAR(ekf.state()[5], 0.6, 0.02);
  const auto estimate = ekf.estimate_at(ekf.time());
  EXPECT_NEAR(estimate.v_world_tag_m_s.norm(), 0.5, 0.01);
  EXPECT_GT(estimate.sigma_p_m.minCoeff(), 0);
}

TEST(TargetEkf, FollowsATargetThatReverses) {
  EXPECT_NEAR(settled(state(0, 0, 0, 1, -0.4, 0)).state()[4], -0.4, 0.01);
}

/// NEES and NIS means over runs whose truth moves just as the filter assumes.
struct Consistency {
  double nees = 0;
  double nis = 0;
  int gated = 0;
};

Consistency consistency(int runs, int pictures) {
  const FilterConfig config;
  Consistency sum;
  for (int run = 0; run < runs; ++run) {
    core::Random random = core::random_stream(static_cast<std::uint64_t>(run + 1), "ekf");
    TargetEkf ekf(config);
    TargetState truth = state(0, 0, 0.2, 2 * kPi * core::uniform01(random),
                              config.initial_speed_sigma_m_s * core::normal(random),
                              config.initial_turn_rate_sigma_rad_s * core::normal(random));
    truth[3] = wrapped(truth[3]);
    const double dt_s = core::seconds(kPicture);
    for (int i = 0; i < pictures; ++i) {
      const auto result = update(ekf, noisy(fix_at(i * kPicture, truth), random));
      sum.gated += result == FixResult::gated || result == FixResult::restarted;
      TargetState error = truth - ekf.state();
      error[3] = wrapped(error[3]);
      if (i == pictures - 1) {
        sum.nees += error.dot(ekf.covariance().ldlt().solve(error)) / runs;
        sum.nis += ekf.nis() / runs;
      }
      const TargetCovariance Q = ctrv_process_noise(truth[3], dt_s, config);
      const TargetCovariance L = Q.llt().matrixL();
      TargetState w;
      for (int k = 0; k < 6; ++k) w[k] = core::normal(random);
      truth = ctrv_predict(truth, dt_s) + L * w;
      truth[3] = wrapped(truth[3]);
    }
  }
  return sum;
}

/// Deviation of the mean of `runs` chi-square values with `dof` degrees of freedom.
double chi2_mean_sigma(int dof, int runs) { return std::sqrt(2.0 * dof / runs); }

TEST(TargetEkf, IsAsCertainAsItIsRight) {
  constexpr int kRuns = 200;  // seeds 1 to 200
  for (const int pictures : {30, 150}) {
    const Consistency found = consistency(kRuns, pictures);
    EXPECT_NEAR(found.nees, 6, 4 * chi2_mean_sigma(6, kRuns)) << pictures;
    EXPECT_NEAR(found.nis, 4, 4 * chi2_mean_sigma(4, kRuns)) << pictures;
    // The gate lets 99.9 % through: 6 of 6000 fixes on average, 30 of 30000.
    const double expected = 0.001 * kRuns * pictures;
    EXPECT_LE(found.gated, expected + 5 * std::sqrt(expected)) << pictures;
  }
}

TEST(TargetEkf, CoastsThroughAGapOnTheCircleItWasOn) {
  const TargetState start = state(0, 0, 0.2, 3, 0.5, 0.6);
  const TargetEkf ekf = settled(start);
  const auto estimate = ekf.estimate_at(ekf.time() + std::chrono::milliseconds(1500));
  const TargetState truth = ctrv_predict(start, 3.5);
  EXPECT_TRUE(estimate.valid);
  // 1.5 s at the speed and turn rate errors allowed above: 0.5 * 0.02 * 1.5^2 / 2
  // + 0.01 * 1.5, and well inside what the filter says itself.
  EXPECT_LT((estimate.p_world_tag_m - truth.head<3>()).norm(), 0.03);
  EXPECT_GT(estimate.sigma_p_m.x(), 0.1);
  EXPECT_EQ(estimate.last_tag, ekf.time());
}

TEST(TargetEkf, PredictsTheSameInOneGoAsPictureByPicture) {
  const TargetEkf ekf = settled(state(0, 0, 0.2, 3, 0.5, 0.6));
  TargetEkf stepped = ekf;
  const Time end = ekf.time() + std::chrono::seconds(1);
  while (stepped.time() < end) stepped.predict(stepped.time() + kPicture);
  const auto at_once = ekf.estimate_at(end), by_steps = stepped.estimate_at(end);
  // The arc is exact; the noise is spread along the heading at 10 or 20 ms.
  EXPECT_LT((at_once.p_world_tag_m - by_steps.p_world_tag_m).norm(), 1e-9);
  EXPECT_LT((at_once.sigma_p_m - by_steps.sigma_p_m).norm(), 1e-3);
}

TEST(TargetEkf, LeavesTheFilterWhereItWasWhenAskedAboutTheFuture) {
  const TargetEkf ekf = settled(state(0, 0, 0.2, 3, 0.5, 0.6));
  const Time before = ekf.time();
  ekf.estimate_at(before + std::chrono::seconds(100));
  EXPECT_EQ(ekf.time(), before);
  EXPECT_TRUE(ekf.started());
}

TEST(TargetEkf, IsValidOnlyAfterEnoughFixes) {
  FilterConfig config;
  config.confirm_fixes = 3;
  TargetEkf ekf(config);
  EXPECT_FALSE(ekf.estimate_at(Time{}).valid);
  const TargetState still = state(1, 2, 0.2, 0, 0, 0);
  EXPECT_EQ(update(ekf, fix_at(Time(0), still)), FixResult::started);
  EXPECT_EQ(update(ekf, fix_at(kPicture, still)), FixResult::fused);
  EXPECT_FALSE(ekf.estimate_at(kPicture).valid);
  EXPECT_EQ(update(ekf, fix_at(2 * kPicture, still)), FixResult::fused);
  EXPECT_TRUE(ekf.estimate_at(2 * kPicture).valid);
  EXPECT_EQ(ekf.update({}), FixResult::none);
}

TEST(TargetEkf, GatesAStrayFixAndIsNotMovedByIt) {
  TargetEkf ekf = settled(state(0, 0, 0.2, 0, 0.5, 0));
  const TargetState expected = ctrv_predict(ekf.state(), core::seconds(kPicture));
  TargetState stray = expected;
  stray[1] += 0.3;
  EXPECT_EQ(update(ekf, fix_at(ekf.time() + kPicture, stray)), FixResult::gated);
  EXPECT_LT((ekf.state() - expected).norm(), 1e-12);
  EXPECT_GT(ekf.nis(), FilterConfig{}.gate_chi2);
}

TEST(TargetEkf, StartsAnewAfterSeveralGatedFixesInARow) {
  TargetEkf ekf = settled(state(0, 0, 0.2, 0, 0.5, 0));
  const TargetState elsewhere = state(5, 5, 0.2, 1, 0, 0);
  for (int i = 1; i < FilterConfig{}.restart_after_gated; ++i)
    EXPECT_EQ(update(ekf, fix_at(ekf.time() + kPicture, elsewhere)), FixResult::gated);
  EXPECT_EQ(update(ekf, fix_at(ekf.time() + kPicture, elsewhere)), FixResult::restarted);
  EXPECT_LT((ekf.state() - elsewhere).norm(), 1e-12);
  EXPECT_FALSE(ekf.estimate_at(ekf.time()).valid);  // to be confirmed again
}

TEST(TargetEkf, LeavesAnUnconfirmedStartAtTheFirstContradiction) {
  TargetEkf ekf{FilterConfig{}};
  update(ekf, fix_at(Time(0), state(9, 9, 0, 0, 0, 0)));
  EXPECT_EQ(update(ekf, fix_at(kPicture, state(0, 0, 0.2, 0, 0, 0))), FixResult::restarted);
  EXPECT_NEAR(ekf.state()[0], 0, 1e-12);
}

TEST(TargetEkf, DropsTheEstimateWhenItHasCoastedTooLong) {
  const TargetEkf ekf = settled(state(0, 0, 0.2, 0, 0.5, 0));
  EXPECT_TRUE(ekf.estimate_at(ekf.time() + std::chrono::milliseconds(3990)).valid);
  EXPECT_FALSE(ekf.estimate_at(ekf.time() + std::chrono::milliseconds(4010)).valid);
  TargetEkf late = ekf;
  EXPECT_EQ(update(late, fix_at(ekf.time() + std::chrono::seconds(5), state(9, 9, 0, 0, 0, 0))),
            FixResult::started);
}

TEST(TargetEkf, ChoosesTheAlternativeNearestToThePrediction) {
  TargetEkf ekf = settled(state(0, 0, 0.2, 0, 0.5, 0));
  const TargetState next = ctrv_predict(ekf.state(), core::seconds(kPicture));
  TargetState turned = next;
  turned[3] += 0.5;
  TagFix wrong = fix_at(ekf.time() + kPicture, turned), right = fix_at(wrong.t, next);
  wrong.tilt_rad = 0.0, right.tilt_rad = 0.2;  // the filter knows better than the tilt
  EXPECT_EQ(ekf.update(std::array{wrong, right}), FixResult::fused);
  EXPECT_NEAR(ekf.state()[3], next[3], 1e-9);
}

TEST(TargetEkf, StartsOnTheMostUprightAlternative) {
  TargetEkf ekf{FilterConfig{}};
  TagFix tilted = fix_at(Time(0), state(1, 0, 0, 0.3, 0, 0));
  TagFix upright = fix_at(Time(0), state(1, 0, 0, 0, 0, 0));
  tilted.tilt_rad = 0.3, upright.tilt_rad = 0.05;
  ekf.update(std::array{tilted, upright});
  EXPECT_NEAR(ekf.state()[3], 0, 1e-12);
}

TEST(TargetEkf, TakesHeadingsAcrossTheWrapForWhatTheyAre) {
  // Turning through west, where the heading jumps from pi to -pi.
  TargetEkf ekf{FilterConfig{}};
  TargetState truth = state(0, 0, 0, kPi - 0.3, 0.5, 0.6);
  for (int i = 0; i < 100; ++i) {
    EXPECT_NE(update(ekf, fix_at(i * kPicture, truth)), FixResult::gated) << i;
    truth = ctrv_predict(truth, core::seconds(kPicture));
  }
  EXPECT_LE(std::abs(ekf.state()[3]), kPi);
  EXPECT_NEAR(ekf.state()[5], 0.6, 0.05);
}

TEST(TargetEkf, RefusesAConfigOutOfRange) {
  FilterConfig config;
  config.gate_chi2 = -1;
  EXPECT_THROW(TargetEkf{config}, std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::tracker
