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
  for (int i = 0; i < 50; ++i) thread.add(i * 1ms, thread.blank_view());
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
  DrawingThread thread(scene, [](const View&, core::Image<float>& picture) {
    if (picture.empty()) picture = core::Image<float>({1, 1}, 0.0f);
    picture(0, 0) += 1;
  });
  for (int i = 1; i <= 3; ++i) {
    thread.add(i * 1ms, thread.blank_view());
    DrawingThread::Picture picture = thread.take();
    EXPECT_EQ(picture.luminance_lux(0, 0), static_cast<float>(i));
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
  for (int i = 0; i < 5; ++i) thread.add(i * 1ms, thread.blank_view());
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
  constexpr int kViews = 1000;
  std::atomic<int> begun = 0;
  {
    DrawingThread thread(scene, [&](const View&, auto&) {
      ++begun;
      std::this_thread::sleep_for(10ms);  // all of them: 10 s
    });
    for (int i = 0; i < kViews; ++i) thread.add(i * 1ms, thread.blank_view());
    while (begun == 0) std::this_thread::yield();
  }
  EXPECT_LT(begun, kViews);
}

}  // namespace
}  // namespace nightjar::sim
