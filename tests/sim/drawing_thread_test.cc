#include "sim/drawing_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>

#include "tests/support/sim_scene.h"

namespace nightjar::sim {
namespace {

using namespace std::chrono_literals;

/// A "drawing" that counts.
void number(int n, core::Image<float>& picture) {
  picture = core::Image<float>({1, 1}, static_cast<float>(n));
}

TEST(DrawingThread, gives_every_picture_once_and_in_order) {
  const Scene scene(test::arena());
  int drawn = 0;  // by the other thread alone
  DrawingThread thread(scene, [&](const View&, auto& picture) { number(drawn++, picture); });
  for (int i = 0; i < 50; ++i) thread.draw(i * 1ms, thread.blank_view());
  for (int i = 0; i < 50; ++i) {
    DrawingThread::Picture picture = thread.take();
    EXPECT_EQ(picture.t, i * 1ms);
    EXPECT_EQ(picture.luminance_lux(0, 0), static_cast<float>(i));
    thread.give_back(std::move(picture));
  }
  EXPECT_EQ(thread.drawn(), 50u);
}

TEST(DrawingThread, draws_again_over_what_was_given_back) {
  const Scene scene(test::arena());
  const float* pixels = nullptr;
  DrawingThread thread(scene, [](const View&, core::Image<float>& picture) {
    if (picture.empty()) picture = core::Image<float>({4, 4});
  });
  for (int i = 0; i < 3; ++i) {
    thread.draw(i * 1ms, thread.blank_view());
    DrawingThread::Picture picture = thread.take();
    if (i > 0) {
      EXPECT_EQ(picture.luminance_lux.pixels().data(), pixels);
    }
    pixels = picture.luminance_lux.pixels().data();
    thread.give_back(std::move(picture));
  }
}

TEST(DrawingThread, tells_why_there_are_no_more_pictures_after_those_there_are) {
  const Scene scene(test::arena());
  int drawn = 0;
  DrawingThread thread(scene, [&](const View&, auto& picture) {
    if (drawn == 2) throw std::runtime_error("out of paint");
    number(drawn++, picture);
  });
  for (int i = 0; i < 5; ++i) thread.draw(i * 1ms, thread.blank_view());
  for (int i = 0; i < 2; ++i) EXPECT_EQ(thread.take().luminance_lux(0, 0), static_cast<float>(i));
  for (int i = 0; i < 2; ++i) {
    try {
      thread.take();
      ADD_FAILURE() << "gave a picture";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), std::string("out of paint"));
    }
  }
}

TEST(DrawingThread, leaves_what_is_not_begun_when_it_goes) {
  const Scene scene(test::arena());
  std::atomic<int> begun = 0;
  std::atomic<bool> may_go_on = false;
  {
    DrawingThread thread(scene, [&](const View&, auto&) {
      ++begun;
      while (!may_go_on) std::this_thread::yield();
      // Time for the destructor to say so; were it later, a second picture would be begun.
      std::this_thread::sleep_for(50ms);
    });
    for (int i = 0; i < 3; ++i) thread.draw(i * 1ms, thread.blank_view());
    while (begun == 0) std::this_thread::yield();
    may_go_on = true;
  }
  EXPECT_EQ(begun, 1);
}

}  // namespace
}  // namespace nightjar::sim
