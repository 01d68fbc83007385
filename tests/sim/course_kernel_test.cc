#include "sim/course_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "core/random.h"

namespace nightjar::sim {
namespace {

/// A course that has reached `level` at its end.
struct Passage {
  ResidualCourse course;
  double level;
};

/// Photoreceptors from none over slow to settled far within the step, signal of both signs.
std::vector<Passage> passages(std::uint64_t seed) {
  core::Random random = core::random_stream(seed, "crossing");
  std::vector<Passage> found;
  for (int i = 0; found.size() < 2000; ++i) {
    const double rate = i % 4 == 0 ? 0 : std::exp(12 * core::uniform01(random) - 6);
    const double change = 2 * core::uniform01(random) - 1;
    const double lag = rate > 0 ? core::uniform01(random) - 0.5 : 0;
    const auto course = ResidualCourse::over_step(change, 0.01, lag, 0.05, rate);
    const double end = course.residual_at_end();
    if (std::abs(end) >= 0.1) found.push_back({course, end > 0 ? 0.1 : -0.1});
  }
  return found;
}

/// The plain reference: halving, 60 times.
double bisected(const Passage& passage) {
  const double sign = passage.level < 0 ? -1 : 1;
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    const bool beyond = sign * (passage.course.residual(middle) - passage.level) >= 0;
    (beyond ? high : low) = middle;
  }
  return high;
}

std::unique_ptr<Crossings> crossings_of(std::span<const Passage> some) {
  auto crossings = std::make_unique<Crossings>();
  for (const Passage& passage : some) crossings->add(passage.course, passage.level, 0, 1);
  return crossings;
}

TEST(ResidualCourse, agrees_with_tiny_steps_of_the_photoreceptor) {
  const double change = 0.8, leak = 0.01, lag = -0.2, rate = 1.7;
  const auto course = ResidualCourse::over_step(change, leak, lag, 0.05, rate);
  constexpr int kSteps = 100'000;  // Euler's error is rate/steps of what moves
  double now_lag = lag;
  for (int i = 0; i < kSteps; ++i) {
    const double s = static_cast<double>(i) / kSteps;
    EXPECT_NEAR(course.residual(s), 0.05 + (change + leak) * s + now_lag - lag, 2e-5);
    now_lag += (-rate * now_lag - change) / kSteps;
  }
  EXPECT_NEAR(course.residual_at_end(), course.residual(1), 1e-15);
}

TEST(ResidualCourse, memorising_and_a_new_leak_leave_no_jump) {
  auto course = ResidualCourse::over_step(0.3, 0.02, -0.1, 0.0, 1.5);
  const double level = course.residual(0.4);
  course.memorise(level);
  EXPECT_NEAR(course.residual(0.4), 0, 1e-15);
  const double later = course.residual(0.9);
  course.change_leak(0.4, 0.12);
  EXPECT_NEAR(course.residual(0.4), 0, 1e-15);
  EXPECT_NEAR(course.residual(0.9), later + 0.1 * 0.5, 1e-15);
}

TEST(Courses, are_set_up_as_one_by_one) {
  core::Random random = core::random_stream(4, "starts");
  const auto uniform = [&] { return static_cast<float>(core::uniform01(random)); };
  CourseStarts starts;
  starts.count = kMostCourses - 3;  // with a remainder
  for (std::uint32_t i = 0; i < starts.count; ++i) {
    starts.change[i] = uniform() - 0.5f;
    starts.leak_per_s[i] = 0.02f;
    starts.lag[i] = uniform() - 0.5f;
    starts.residual[i] = 0.2f * uniform();
  }
  for (const float rate : {0.0f, 0.2f, 100.0f}) {
    for (std::uint32_t i = 0; i < starts.count; ++i) starts.rate[i] = rate * uniform();
    for (const CourseVariant& variant : course_variants()) {
      variant.set_up(starts, 2e-3);
      for (std::uint32_t i = 0; i < starts.count; ++i) {
        const auto one =
            ResidualCourse::over_step(starts.change[i], starts.leak_per_s[i] * 2e-3, starts.lag[i],
                                      starts.residual[i], starts.rate[i]);
        EXPECT_EQ(std::memcmp(&one, &starts.course[i], sizeof(one)), 0) << variant.name << i;
      }
    }
  }
}

TEST(Crossings, are_found_to_the_tolerance) {
  constexpr double kTolerance = 1e-5;
  const auto all = passages(5);
  for (std::size_t begin = 0; begin < all.size(); begin += 250) {
    const std::span some = std::span(all).subspan(begin, 250);
    const auto crossings = crossings_of(some);
    solve(*crossings, kTolerance);
    for (std::size_t i = 0; i < some.size(); ++i)
      EXPECT_NEAR(crossings->s[i], bisected(some[i]), kTolerance);
  }
}

TEST(Crossings, do_not_depend_on_their_neighbours_nor_on_the_instruction_set) {
  const auto all = passages(6);
  const std::span some = std::span(all).first(kMostCourses - 3);
  const auto variants = course_variants();
  const auto plain = crossings_of(some);
  solve(variants.front(), *plain, 1e-5);
  for (const CourseVariant& variant : variants) {
    const auto crossings = crossings_of(some);
    solve(variant, *crossings, 1e-5);
    for (std::size_t i = 0; i < some.size(); ++i) {
      EXPECT_EQ(crossings->s[i], plain->s[i]) << variant.name;
      const auto alone = crossings_of(some.subspan(i, 1));
      solve(variant, *alone, 1e-5);
      EXPECT_EQ(alone->s[0], plain->s[i]) << variant.name;
    }
  }
}

TEST(Crossings, lie_between_their_ends) {
  const auto rising = ResidualCourse::over_step(1.0, 0, 0, 0, 0);
  Crossings crossings;
  crossings.add(rising, 0.25, 0.5, 1);     // passed before
  crossings.add(rising, 0.25, 0.0, 0.25);  // reached just at the end
  solve(crossings, 1e-6);
  EXPECT_EQ(crossings.s[0], 0.5);
  EXPECT_EQ(crossings.s[1], 0.25);
}

}  // namespace
}  // namespace nightjar::sim
