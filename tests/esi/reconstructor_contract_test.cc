// What every reconstructor promises, whatever its algorithm.

#include <gtest/gtest.h>

#include <memory>

#include "esi/make_network.h"
#include "tests/support/events.h"
#include "tests/support/frames.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_network.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSensor{16, 12};

struct Variant {
  const char* name;
  ReconstructorConfig config;

  std::unique_ptr<Reconstructor> make() const {
    const test::ScratchFolder folder;  // for a network's weights, which are read at once
    ReconstructorConfig complete = config;
    complete.firenet.weights =
        test::TinyNetwork{.size = kSensor}.write(folder / "tiny.onnx").string();
    return make_any_reconstructor(complete, kSensor);
  }
};

/// A method as it is configured by default, but for `change`.
template <class Change>
Variant variant(const char* name, Method method, Change change) {
  ReconstructorConfig config;
  config.method = method;
  change(config);
  return {name, config};
}

Variant variant(const char* name, Method method) {
  return variant(name, method, [](ReconstructorConfig&) {});
}

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

TEST_P(ReconstructorContract, TakesNoEventsAtAll) {
  a_->process(std::span<const core::Event>{});
  a_->process(std::span<const PackedEvent>{});
  EXPECT_EQ(picture(*a_, 1s), picture(*b_, 1s));
}

TEST_P(ReconstructorContract, PackedEventsGiveTheSamePicture) {
  std::vector<PackedEvent> packed;
  for (const core::Event& e : events_) packed.push_back(pack(e, kSensor.width_px));
  a_->process(events_);
  b_->process(packed);
  EXPECT_EQ(picture(*a_, 1s), picture(*b_, 1s));
}

TEST_P(ReconstructorContract, PictureIgnoresWhereBatchesAreCutBetweenFrames) {
  const auto half = std::span(events_).first(events_.size() / 2);
  const auto rest = std::span(events_).subspan(half.size());
  const core::Time at = half.back().t;
  const auto frame = test::random_frame(kSensor, at - 100ms, at, 8, /*seed=*/1);
  a_->process(half);
  for (const core::Event& e : half) b_->process({&e, 1});
  for (auto* each : {a_.get(), b_.get()}) each->add_frame(frame);
  EXPECT_EQ(picture(*a_, at), picture(*b_, at));
  a_->process(rest);
  for (const core::Event& e : rest) b_->process({&e, 1});
  EXPECT_EQ(picture(*a_, 1s), picture(*b_, 1s));
}

TEST_P(ReconstructorContract, ResetForgetsTheFrames) {
  a_->process(events_);
  a_->add_frame(test::random_frame(kSensor, 500ms, 1s, 8, /*seed=*/1));
  a_->reset();
  a_->add_frame(
      test::random_frame(kSensor, 100ms, 200ms, 8, /*seed=*/2));  // earlier: allowed again
  a_->reset();
  EXPECT_EQ(picture(*a_, 0s), picture(*b_, 0s));
}

TEST_P(ReconstructorContract, RefusesFramesThatCannotBeAndStaysAsItWas) {
  const auto good = test::random_frame(kSensor, 500ms, 1s, 8, /*seed=*/1);
  a_->process(events_);
  a_->add_frame(good);
  const auto before = picture(*a_, 1s);
  const auto refuses = [&](auto change) {
    core::ApsFrame frame = good;
    change(frame);
    EXPECT_THROW(a_->add_frame(frame), std::invalid_argument);
    EXPECT_EQ(picture(*a_, 1s), before);
  };
  refuses([](auto& f) { f.gray = core::Image<std::uint16_t>({12, 16}); });
  refuses([](auto& f) { f.gray = {}; });
  refuses([](auto& f) { f.exposure_end = f.exposure_begin; });
  refuses([](auto& f) { f.exposure_begin = f.exposure_end = {}; });
  refuses([](auto& f) { f.exposure_begin = 499ms; });  // before its predecessor
  refuses([](auto& f) { f.bits = 9; });
  refuses([](auto& f) { f.gray(3, 4) = 256; });
  refuses([](auto& f) {
    f.bits = 10;
    f.gray(3, 4) = 1024;
  });
}

TEST_P(ReconstructorContract, HoursWithoutEventsKeepItSound) {
  for (auto* each : {a_.get(), b_.get()}) each->process(events_);
  a_->process(std::vector<core::Event>{{3h, 1, 1, true}, {9h, 1, 1, true}});
  b_->process(std::vector<core::Event>{{3h, 1, 1, true}});
  b_->process(std::vector<core::Event>{{9h, 1, 1, true}});
  EXPECT_EQ(picture(*a_, 20h), picture(*b_, 20h));
}

INSTANTIATE_TEST_SUITE_P(
    EveryVariant, ReconstructorContract,
    testing::Values(variant("esi", Method::esi),
                    variant("esi_power", Method::esi, [](auto& c) { c.esi.decay_power = 2.5; }),
                    variant("esi_decay_then_add", Method::esi,
                            [](auto& c) {
                              c.esi.order = EsiOrder::decay_then_add;
                              c.esi.decay_at_picture = true;
                            }),
                    variant("accumulator", Method::accumulator),
                    variant("accumulator_linear", Method::accumulator,
                            [](auto& c) { c.accumulator.decay = AccumulatorDecay::linear; }),
                    variant("accumulator_without_decay", Method::accumulator,
                            [](auto& c) { c.accumulator.decay = AccumulatorDecay::none; }),
                    variant("complementary_filter", Method::complementary_filter),
                    variant("complementary_filter_bilateral", Method::complementary_filter,
                            [](auto& c) {
                              c.complementary_filter.filter = SpatialFilter::bilateral;
                            }),
                    variant("high_pass_filter", Method::complementary_filter,
                            [](auto& c) { c.complementary_filter.use_frames = false; }),
                    variant("edi", Method::edi), variant("fedi", Method::fedi),
                    variant("htac", Method::htac), variant("esi_net", Method::esi_net),
                    variant("esi_net_events_alone", Method::esi_net,
                            [](auto& c) { c.esi_net.use_frames = false; }),
                    variant("firenet", Method::firenet)),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace nightjar::esi
