#include "sim/course_kernel.h"

#include <cmath>

#include "core/instruction_sets.h"

namespace nightjar::sim {
namespace {

[[gnu::always_inline]] inline void set_up_body(CourseStarts& c, double dt_s) {
  const std::uint32_t count = c.count;
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    c.course[i] = ResidualCourse::over_step(c.change[i], c.leak_per_s[i] * dt_s, c.lag[i],
                                            c.residual[i], c.rate[i]);
  }
}

/// Starts on the chord between the two ends.
[[gnu::always_inline]] inline void start_body(Crossings& c) {
  const std::uint32_t count = c.count;
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    const double from = c.from[i];
    const double to = c.to[i];
    const double at_from =
        c.offset[i] + c.slope[i] * from + c.bend[i] * fast_exp_minus(c.rate[i] * from);
    const double at_to = c.offset[i] + c.slope[i] * to + c.bend[i] * fast_exp_minus(c.rate[i] * to);
    const double chord = from + (to - from) * (at_from / (at_from - at_to));
    const bool passed = at_from >= 0;
    c.s[i] = select(passed, from, select(at_to > 0, chord, to));
    c.settled[i] = static_cast<std::uint64_t>(passed);
  }
}

/// One step of Newton's method. The curve bends one way only: from the end where it bends
/// away from 0 Newton's method comes nearer from one side and cannot miss. One step from
/// the chord leads to that side, or, off the slope's sign, is replaced by that end.
[[gnu::always_inline]] inline std::uint64_t improve_body(Crossings& c, double tolerance) {
  const std::uint32_t count = c.count;
  std::uint64_t moving = 0;
#pragma GCC ivdep
  for (std::uint32_t i = 0; i < count; ++i) {
    const double s = c.s[i];
    const double from = c.from[i];
    const double to = c.to[i];
    const double bent = c.bend[i] * fast_exp_minus(c.rate[i] * s);
    const double value = c.offset[i] + c.slope[i] * s + bent;
    const double slope = c.slope[i] - c.rate[i] * bent;
    const double tangent = s - value / slope;
    const double inside = select(tangent > from, select(tangent < to, tangent, to), from);
    const double next = select(slope > 0, inside, select(c.bend[i] > 0, to, from));
    const std::uint64_t settled = c.settled[i];
    const std::uint64_t close = static_cast<std::uint64_t>(std::abs(next - s) <= tolerance);
    c.s[i] = select(settled != 0, s, next);
    c.settled[i] = settled | close;
    moving += 1 - (settled | close);
  }
  return moving;
}

void set_up_plain(CourseStarts& c, double dt_s) { set_up_body(c, dt_s); }
void start_plain(Crossings& c) { start_body(c); }
std::uint64_t improve_plain(Crossings& c, double tolerance) { return improve_body(c, tolerance); }

#if defined(__x86_64__)
[[gnu::target("avx2")]] void set_up_avx2(CourseStarts& c, double dt_s) { set_up_body(c, dt_s); }
[[gnu::target("avx2")]] void start_avx2(Crossings& c) { start_body(c); }
[[gnu::target("avx2")]] std::uint64_t improve_avx2(Crossings& c, double tolerance) {
  return improve_body(c, tolerance);
}

[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]] void set_up_avx512(CourseStarts& c,
                                                                         double dt_s) {
  set_up_body(c, dt_s);
}
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]] void start_avx512(Crossings& c) {
  start_body(c);
}
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]] std::uint64_t improve_avx512(
    Crossings& c, double tolerance) {
  return improve_body(c, tolerance);
}
#endif

}  // namespace

std::vector<CourseVariant> course_variants() {
  std::vector<CourseVariant> variants{{"plain", set_up_plain, start_plain, improve_plain}};
#if defined(__x86_64__)
  if (core::instruction_sets().avx2) variants.push_back({"avx2", set_up_avx2, start_avx2, improve_avx2});
  if (core::instruction_sets().avx512)
    variants.push_back({"avx512", set_up_avx512, start_avx512, improve_avx512});
#endif
  return variants;
}

namespace {

const CourseVariant& best() {
  static const CourseVariant variant = course_variants().back();
  return variant;
}

}  // namespace

void solve(const CourseVariant& variant, Crossings& crossings, double tolerance) {
  variant.start(crossings);
  // Three or four will do but for a photoreceptor that settles far within the step.
  constexpr int kMostIterations = 100;
  for (int i = 0; i < kMostIterations; ++i)
    if (variant.improve(crossings, tolerance) == 0) break;
}

void set_up(CourseStarts& starts, double dt_s) { best().set_up(starts, dt_s); }

void solve(Crossings& crossings, double tolerance) { solve(best(), crossings, tolerance); }

}  // namespace nightjar::sim
