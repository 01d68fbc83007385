#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/pixel.h"

namespace nightjar::sim {

/// How many columns the tables below have.
inline constexpr std::uint32_t kMostCourses = 704;

/// Pixels whose course through a step is to be set up, many at a time: one column each.
struct alignas(64) CourseStarts {
  std::uint32_t count = 0;
  // Over the step, as in ResidualCourse::over_step.
  float change[kMostCourses], leak_per_s[kMostCourses], lag[kMostCourses], residual[kMostCourses];
  float rate[kMostCourses];
  ResidualCourse course[kMostCourses];  ///< The result.
};

/// Every instruction set gives the same bits.
void set_up(CourseStarts& starts, double dt_s);

/// Threshold crossings to be found, many at a time: one column each.
struct alignas(64) Crossings {
  std::uint32_t count = 0;
  // offset + slope s + bend exp(-rate s) is below 0 at `from` and has reached 0 at `to`.
  double offset[kMostCourses], slope[kMostCourses], bend[kMostCourses], rate[kMostCourses];
  double from[kMostCourses], to[kMostCourses];
  double level[kMostCourses];  ///< As given to `add`.
  double s[kMostCourses];      ///< The result.
  std::uint64_t settled[kMostCourses];

  /// Appends the first passage of the level `passed` in [from_s, to_s] by a residual that
  /// has reached it at `to_s`. There is just one, since the residual has at most one
  /// extremum.
  void add(const ResidualCourse& course, double passed, double from_s, double to_s) {
    const double sign = std::copysign(1.0, passed);
    level[count] = passed;
    offset[count] = sign * (course.offset - passed);
    slope[count] = sign * course.slope;
    bend[count] = sign * course.bend;
    rate[count] = course.rate;
    from[count] = from_s;
    to[count] = to_s;
    ++count;
  }
};

/// Finds every `s` to `tolerance`; a level passed before `from` gives `from`. Each result
/// depends on its own column alone, and every instruction set gives the same bits.
void solve(Crossings& crossings, double tolerance);

/// What the functions above take for one instruction set.
struct CourseVariant {
  const char* name;
  void (*set_up)(CourseStarts&, double dt_s);
  void (*start)(Crossings&);
  std::uint64_t (*improve)(Crossings&, double tolerance);  ///< Returns how many are not settled.
};

/// Those this processor can run, slowest first; the functions above use the last of them.
std::vector<CourseVariant> course_variants();

void solve(const CourseVariant& variant, Crossings& crossings, double tolerance);

}  // namespace nightjar::sim
