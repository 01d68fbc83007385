// What every reconstructor promises, whatever its algorithm.

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "esi/esi.h"
#include "tests/support/events.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSensor{16, 12};

struct Variant {
  const char* name;
  std::function<std::unique_ptr<Reconstructor>()> make;
};

class ReconstructorContract : public testing::TestWithParam<Variant> {
 protected:
  core::Image<std::uint8_t> picture(Reconstructor& r, core::Time t) const {
    core::Picture picture;
    r.render(t, picture);
    EXPECT_EQ(picture.t, t);
    return picture.gray;
  }

  const std::vector<core::Event> events_ = test::random_events(kSensor, 20000, 1s, /*seed=*/7);
  std::unique_ptr<Reconstructor> a_ = GetParam().make();
  std::unique_ptr<Reconstructor> b_ = GetParam().make();
};

TEST_P(ReconstructorContract, PictureIgnoresWhereBatchesAreCut) {
  a_->process(events_);
  for (const core::Event& e : events_) b_->process({&e, 1});
  EXPECT_EQ(picture(*a_, 1s), picture(*b_, 1s));
}

TEST_P(ReconstructorContract, PictureDependsOnTheEvents) {
  a_->process(events_);
  EXPECT_NE(picture(*a_, 1s), picture(*b_, 1s));
}

TEST_P(ReconstructorContract, ResetForgetsTheEvents) {
  a_->process(events_);
  a_->reset();
  EXPECT_EQ(picture(*a_, 0s), picture(*b_, 0s));
}

TEST_P(ReconstructorContract, LookingTwiceChangesNothing) {
  a_->process(events_);
  EXPECT_EQ(picture(*a_, 1s), picture(*a_, 1s));
}

TEST_P(ReconstructorContract, RefusesEventsOutsideTheSensorAndKeepsThoseBefore) {
  const std::vector<core::Event> bad = {{1ms, 3, 3, true}, {2ms, 16, 0, true}};
  EXPECT_THROW(a_->process(bad), std::invalid_argument);
  b_->process({bad.data(), 1});
  EXPECT_EQ(picture(*a_, 2ms), picture(*b_, 2ms));
}

TEST_P(ReconstructorContract, RefusesTimeRunningBackwards) {
  const std::vector<core::Event> bad = {{2ms, 3, 3, true}, {1ms, 3, 3, true}};
  EXPECT_THROW(a_->process(bad), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(EveryVariant, ReconstructorContract,
                         testing::Values(Variant{
                             "esi", [] { return std::make_unique<Esi>(EsiConfig{}, kSensor); }}),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace nightjar::esi
