#include "sim/pixel_walks.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace nightjar::sim {

PixelWalks::PixelWalks(const PixelConfig& config, std::uint32_t pixels, Leak leak)
    : refractory_us_(config.refractory_us),
      leak_(std::move(leak)),
      rest_until_us_(config.refractory_us > 0 ? pixels : 0, -1e300) {
  walks_.reserve(kMostCourses);
  open_.reserve(kMostCourses);
}

void PixelWalks::begin_step(core::Time begin, core::Time dt) {
  begin_us_ = static_cast<double>(begin.count());
  dt_us_ = static_cast<double>(dt.count());
  per_us_ = 1 / dt_us_;
}

void PixelWalks::set_off() {
  set_up(starts_, dt_us_ * 1e-6);
  open_.resize(walks_.size());
  std::iota(open_.begin(), open_.end(), 0u);
  if (rest_until_us_.empty()) return;
  for (const std::uint32_t k : open_) {
    ResidualCourse& course = starts_.course[k];
    const double awake = std::max(0.0, in_step(rest_until_us_[walks_[k].pixel]));
    if (awake > 0 && awake <= 1) course.memorise(course.residual(awake));
    walks_[k].awake = awake;
  }
}

// Inlined below: calls would cost half as much as what they do.

/// One event at `s`, with the residual at `level`.
[[gnu::always_inline]] inline void PixelWalks::fire(std::uint32_t k, double s, double level,
                                                    bool on, FiredEvents& fired) {
  Walk& walk = walks_[k];
  ResidualCourse& course = starts_.course[k];
  // The first whole microsecond not before it, so that it lies in (begin, end].
  const double exact_us = std::clamp(s * dt_us_, 0.5, dt_us_);
  const auto floor_us = static_cast<std::uint32_t>(exact_us);
  fired.add(floor_us + (floor_us < exact_us), walk.pixel, on);
  course.memorise(level);
  if (leak_.enabled()) {
    const float leak_per_s = leak_.next_per_s(walk.pixel);
    walk.block->leak_per_s[walk.i] = leak_per_s;
    course.change_leak(s, leak_per_s * dt_us_ * 1e-6);
  }
  walk.awake = s;
  if (rest_until_us_.empty()) return;
  walk.awake += refractory_us_ * per_us_;
  rest_until_us_[walk.pixel] = begin_us_ + walk.awake * dt_us_;
  // Held in reset, it memorises what it wakes up to.
  if (walk.awake <= 1) course.memorise(course.residual(walk.awake));
}

[[gnu::always_inline]] inline void PixelWalks::finish(std::uint32_t k) {
  const Walk& walk = walks_[k];
  const bool rests = walk.awake > 1;
  if (rests) resting_.push_back(walk.pixel);
  walk.block->residual[walk.i] =
      rests ? 0.0f : static_cast<float>(starts_.course[k].residual_at_end());
}

/// Fires the noise that comes before the pixel's next crossing and asks for that crossing's
/// time. False, and the walk is finished, if there is none in this step.
[[gnu::always_inline]] inline bool PixelWalks::go_to_crossing(std::uint32_t k, FiredEvents& fired,
                                                              EmulatorCounts& counts) {
  Walk& walk = walks_[k];
  const ResidualCourse& course = starts_.course[k];
  const double on = walk.threshold_on;
  const double off = walk.threshold_off;
  const auto crosses = [&](double residual, double to) {
    // Nobody can guess the sign, so that there is no branch for it.
    const bool up = residual >= on;
    if (!((walk.awake < to) & (up | (residual <= -off)))) return false;
    crossings_.add(course, select(up, on, -off), walk.awake, to);
    return true;
  };
  for (; !walk.noise.empty(); walk.noise = walk.noise.subspan(1)) {
    const NoiseCandidate& noise = walk.noise.front();
    const double s = in_step(noise.t_us);
    if (walk.awake > s) continue;
    const double residual = course.residual(s);
    if (crosses(residual, s)) return true;
    ++(noise.kind == NoiseCandidate::hot ? counts.hot : counts.shot);
    fire(k, s, residual, noise.kind != NoiseCandidate::shot_off, fired);
  }
  if (crosses(course.residual_at_end(), 1)) return true;
  finish(k);
  return false;
}

void PixelWalks::run(FiredEvents& fired, EmulatorCounts& counts) {
  set_off();
  constexpr double kToleranceUs = 0.05;
  while (!open_.empty()) {
    crossings_.count = 0;
    // Nobody can guess which are finished, so that there is no branch for it; a loop of our own,
    // since std::erase_if would call what is inlined here.
    std::size_t still_open = 0;
    for (const std::uint32_t k : open_) {
      open_[still_open] = k;
      still_open += go_to_crossing(k, fired, counts);
    }
    open_.resize(still_open);
    solve(crossings_, kToleranceUs / dt_us_);
    for (std::uint32_t k = 0; k < crossings_.count; ++k)
      fire(open_[k], crossings_.s[k], crossings_.level[k], crossings_.level[k] > 0, fired);
    counts.signal += crossings_.count;
  }
  walks_.clear();
  starts_.count = 0;
}

std::vector<std::uint32_t> PixelWalks::take_resting() {
  std::ranges::sort(resting_);
  return std::exchange(resting_, {});
}

}  // namespace nightjar::sim
