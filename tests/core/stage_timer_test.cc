#include "core/stage_timer.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace nightjar::core {
namespace {

TEST(StageTimer, hands_on_what_the_work_gives) {
  StageTimer timer("stage", "thread");
  int value = 1;
  int& same = timer([&]() -> int& { return value; });
  EXPECT_EQ(&same, &value);
}

TEST(StageTimer, counts_every_call_also_one_that_throws) {
  StageTimer timer("stage", "thread");
  timer([] {});
  EXPECT_THROW(timer([] { throw std::runtime_error("work"); }), std::runtime_error);
  EXPECT_EQ(timer.time().calls, 2u);
  EXPECT_GE(timer.time().wall.count(), 0);
}

TEST(StageTimer, adds_up_the_time_from_begin_to_end) {
  StageTimer timer("stage", "thread");
  const auto begin = std::chrono::steady_clock::now();
  auto inner = begin;
  for (int i = 0; i < 2; ++i)
    timer([&] {
      const auto now = std::chrono::steady_clock::now();
      while (std::chrono::steady_clock::now() - now < std::chrono::microseconds(200)) {
      }
      inner += std::chrono::steady_clock::now() - now;
    });
  // No less than the work measured within, no more than all that passed.
  EXPECT_GE(timer.time().wall, inner - begin);
  EXPECT_LE(timer.time().wall, std::chrono::steady_clock::now() - begin);
}

}  // namespace
}  // namespace nightjar::core
