#include "esi/recurrent_network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "esi/make_network.h"
#include "tests/support/data_folder.h"
#include "tests/support/events.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/tiny_network.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr core::Resolution kSensor{12, 9};

class RecurrentNetworkTest : public testing::Test {
 protected:
  NetworkConfig plain(const test::TinyNetwork& network) const {
    return {.weights = network.write(folder_ / "tiny.onnx").string(),
            .normalise = false,
            .stretch = false};
  }

  /// What the constructor says of it.
  static std::string complaint(const NetworkConfig& config, core::Resolution size = kSensor) {
    try {
      RecurrentNetwork("firenet", config, size);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  }

  static core::Image<std::uint8_t> picture(Reconstructor& r, core::Time t) {
    core::Picture picture;
    r.render(t, picture);
    return picture.gray;
  }

  test::ScratchFolder folder_;
};

TEST_F(RecurrentNetworkTest, carries_its_state_from_picture_to_picture) {
  RecurrentNetwork network("firenet", plain({.size = kSensor}), kSensor);
  EXPECT_EQ(picture(network, 0s)(3, 4), 128);
  network.process(std::vector<core::Event>{{1ms, 3, 4, true}});
  // v = 1: image = 0.25, state = 1.
  EXPECT_EQ(picture(network, 10ms)(3, 4), 64);  // 63.75
  EXPECT_EQ(picture(network, 20ms)(3, 4), 64);  // another look
  network.process(std::vector<core::Event>{{21ms, 3, 4, true}});
  // image = 0.25 + 0.5 * 1, state = 1.5.
  EXPECT_EQ(picture(network, 30ms)(3, 4), 191);  // 191.25
  EXPECT_EQ(picture(network, 30ms)(0, 0), 0);
  network.process(std::vector<core::Event>{{31ms, 0, 0, false}});
  EXPECT_EQ(picture(network, 40ms)(3, 4), 191);  // 0.5 * 1.5
  network.reset();
  network.process(std::vector<core::Event>{{1ms, 3, 4, true}});
  EXPECT_EQ(picture(network, 10ms)(3, 4), 64);
}

TEST_F(RecurrentNetworkTest, gives_the_same_wherever_batches_are_cut) {
  const NetworkConfig config = {.weights = plain({.size = kSensor}).weights};
  RecurrentNetwork a("firenet", config, kSensor), b("firenet", config, kSensor);
  const auto events = test::random_events(kSensor, 5000, 1s, /*seed=*/7);
  for (int k = 0; k < 2; ++k) {
    const auto half = std::span(events).subspan(k * events.size() / 2, events.size() / 2);
    a.process(half);
    for (const core::Event& e : half) b.process({&e, 1});
    const core::Time t = half.back().t;
    EXPECT_EQ(picture(a, t), picture(b, t));
  }
}

TEST_F(RecurrentNetworkTest, runs_at_other_sizes_than_the_files) {
  RecurrentNetwork network("firenet", plain({.size = {346, 260}}), kSensor);
  network.process(std::vector<core::Event>{{1ms, 11, 8, true}});
  EXPECT_EQ(picture(network, 10ms)(11, 8), 64);
}

TEST_F(RecurrentNetworkTest, grows_the_planes_to_what_a_shrinking_state_needs) {
  // 13x9 becomes 14x10 for a state of half the side.
  constexpr core::Resolution kOdd{13, 9};
  RecurrentNetwork network("e2vid", plain({.size = {8, 6}, .shrink = 2}), kOdd);
  network.process(std::vector<core::Event>{{1ms, 12, 8, true}, {2ms, 0, 8, true}});
  const auto gray = picture(network, 10ms);
  EXPECT_EQ(gray.size(), kOdd);
  EXPECT_EQ(gray(12, 8), 64);
  EXPECT_EQ(gray(0, 8), 64);
  EXPECT_EQ(gray(12, 7), 0);
}

TEST_F(RecurrentNetworkTest, stretches_the_levels_between_two_quantiles) {
  NetworkConfig config = plain({.size = kSensor});
  config.stretch = true;
  RecurrentNetwork network("firenet", config, kSensor);
  std::vector<core::Event> events;
  for (int x = 0; x < 12; ++x)
    for (int i = 0; i < x; ++i)  // 0 to 11 events a pixel, all in one row of the nine
      events.push_back({1ms, static_cast<std::uint16_t>(x), 0, true});
  network.process(events);
  const auto gray = picture(network, 10ms);
  EXPECT_EQ(gray(0, 5), 0);
  EXPECT_EQ(gray(11, 0), 255);
  EXPECT_NEAR(gray(5, 0), 255.0 * 5 / 10, 0.51);  // of 108 values, 10/4 is above 99 %: rounding
}

TEST_F(RecurrentNetworkTest, asks_for_weights) {
  EXPECT_EQ(complaint({}), "firenet needs weights: reconstructor.firenet.weights = FILE.onnx");
  EXPECT_EQ(complaint({.weights = "none.onnx"}), "none.onnx: cannot be read");
  EXPECT_EQ(complaint({.weights = folder_.path().string()}),
            folder_.path().string() + ": cannot be read");
}

TEST_F(RecurrentNetworkTest, refuses_files_of_another_kind) {
  std::ofstream(folder_ / "text.onnx") << "no network\n";
  EXPECT_THAT(complaint({.weights = (folder_ / "text.onnx").string()}),
              HasSubstr("text.onnx: is no ONNX network"));
  EXPECT_THAT(complaint(plain({.size = kSensor, .voxels = "events"})),
              HasSubstr("its inputs are events 1x5x9x12, state0_in 1x1x9x12 and its outputs image "
                        "1x1x9x12, state0_out 1x1x9x12, expected voxels 1x5xHxW"));
  EXPECT_THAT(complaint(plain({.size = kSensor, .bins = 3})), HasSubstr("voxels 1x3x9x12"));
  EXPECT_THAT(complaint(plain({.size = kSensor, .state_in = "state1_in"})),
              HasSubstr("state1_in 1x1x9x12"));
  EXPECT_THAT(complaint(plain({.size = kSensor, .state_out = "memory"})),
              HasSubstr("memory 1x1x9x12"));
  EXPECT_THAT(complaint(plain({.size = {9, 7}, .shrink = 2})), HasSubstr("state0_in 1x1x3x4"));
}

TEST_F(RecurrentNetworkTest, refuses_a_file_cut_short) {
  const std::string path = plain({.size = kSensor}).weights;
  const std::string whole = test::file_text(path);
  std::ofstream(path, std::ios::binary) << whole.substr(0, whole.size() / 2);
  EXPECT_THAT(complaint({.weights = path}), HasSubstr("tiny.onnx: is no ONNX network"));
}

TEST_F(RecurrentNetworkTest, refuses_a_network_that_opencv_cannot_run_without_printing) {
  const NetworkConfig config = plain({.size = {8, 6}, .state_channels = 2});
  testing::internal::CaptureStderr();
  EXPECT_THAT(complaint(config), HasSubstr("cannot run it at 12x9"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(RecurrentNetworkTest, is_built_for_both_names) {
  ReconstructorConfig config;
  config.method = Method::e2vid;
  config.e2vid = plain({.size = kSensor});
  EXPECT_EQ(make_any_reconstructor(config, kSensor)->size(), kSensor);
  config.method = Method::firenet;
  EXPECT_THROW(make_any_reconstructor(config, kSensor), std::invalid_argument);
  config.method = Method::esi;
  EXPECT_EQ(make_any_reconstructor(config, kSensor)->size(), kSensor);
}

/// FireNet itself, whose receptive field is far smaller than what is cut off here: the
/// middle of a small sensor sees what the same part of the file's own size sees.
TEST_F(RecurrentNetworkTest, runs_firenet_at_any_size) {
  const auto data = test::data_folder();
  if (!data) GTEST_SKIP() << "no recordings";
  NetworkConfig config{.weights = (*data / "firenet" / "firenet.onnx").string(),
                       .normalise = false,
                       .stretch = false};
  constexpr core::Resolution kSmall{96, 80}, kFull{346, 260};
  RecurrentNetwork small("firenet", config, kSmall), full("firenet", config, kFull);
  const auto events = test::random_events(kSmall, 20000, 10ms, /*seed=*/2);
  small.process(events);
  full.process(events);
  const auto a = picture(small, 10ms), b = picture(full, 10ms);
  int differing = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 70; ++x) {
      ASSERT_NEAR(a(x, y), b(x, y), 1) << x << ' ' << y;  // sums taken in another order
      differing += a(x, y) != b(40, 40);
    }
  EXPECT_GT(differing, 1000);  // it is a picture
}

}  // namespace
}  // namespace nightjar::esi
