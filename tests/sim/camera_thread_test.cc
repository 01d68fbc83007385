#include "sim/camera_thread.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace nightjar::sim {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSize{32, 24};
constexpr std::uint64_t kSeed = 5;
constexpr double kWhite_lux = 5.0;

SimulatedCamera make_camera() { return {SensorConfig{}, kSize, kWhite_lux, kSeed}; }

/// A picture that wanders, so that every one of them gives other events.
void draw(int k, core::Image<float>& luminance_lux) {
  if (luminance_lux.empty()) luminance_lux = core::Image<float>(kSize);
  for (int y = 0; y < kSize.height_px; ++y)
    for (int x = 0; x < kSize.width_px; ++x)
      luminance_lux(x, y) = static_cast<float>(1 + (x + 2 * y + 3 * k) % 8);
}

TEST(CameraThread, gives_what_the_camera_gives_without_it) {
  SimulatedCamera alone = make_camera(), threaded = make_camera();
  CameraThread thread(threaded);
  core::Image<float> picture;
  std::vector<core::EventPacket> expected;
  for (int k = 0; k < 40; ++k) {
    draw(k, picture);
    alone.expose(k * 1ms, picture);
    draw(k, thread.next());
    thread.expose(k * 1ms, k % 10 == 9);
    if (k % 10 == 9) expected.push_back(alone.take_packet());
    if (k % 20 != 19) continue;  // so that two packets wait
    for (const core::EventPacket& packet : expected) {
      const core::EventPacket taken = thread.take().packet;
      EXPECT_EQ(taken.begin, packet.begin);
      EXPECT_EQ(taken.end, packet.end);
      EXPECT_FALSE(taken.events.empty());
      EXPECT_EQ(taken.events, packet.events);
    }
    expected.clear();
  }
}

TEST(CameraThread, what_the_camera_throws_comes_out_of_take) {
  SimulatedCamera camera = make_camera();
  CameraThread thread(camera);
  for (const core::Time t : {1ms, 2ms, 2ms, 3ms}) {  // stands still once
    draw(0, thread.next());
    thread.expose(t, false);
  }
  EXPECT_THROW(thread.take(), std::invalid_argument);
  draw(0, thread.next());  // and nobody waits for ever
  thread.expose(4ms, true);
  EXPECT_THROW(thread.take(), std::invalid_argument);
}

TEST(CameraThread, packets_complete_before_the_error_come_out_first) {
  SimulatedCamera camera = make_camera();
  CameraThread thread(camera);
  for (const core::Time t : {1ms, 2ms, 2ms}) {
    draw(0, thread.next());
    thread.expose(t, t == 1ms);
  }
  thread.next();  // returns once the first picture, at least, is exposed
  EXPECT_EQ(thread.take().packet.end, 1ms);
  EXPECT_THROW(thread.take(), std::invalid_argument);
}

TEST(CameraThread, tells_why_there_are_no_more_pictures) {
  SimulatedCamera camera = make_camera();
  CameraThread thread(camera);
  draw(0, thread.next());
  thread.expose(1ms, true);
  EXPECT_EQ(thread.take().packet.end, 1ms);
  thread.fail(std::make_exception_ptr(std::runtime_error("out of paint")));
  thread.fail(std::make_exception_ptr(std::logic_error("later")));
  EXPECT_THROW(thread.take(), std::runtime_error);
}

TEST(CameraThread, may_go_with_pictures_still_to_be_exposed) {
  SimulatedCamera camera = make_camera();
  CameraThread thread(camera);
  for (int k = 0; k < 3; ++k) {
    draw(k, thread.next());
    thread.expose(k * 1ms, false);
  }
}

}  // namespace
}  // namespace nightjar::sim
