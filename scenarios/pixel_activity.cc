#include "scenarios/pixel_activity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace nightjar::scenarios {
namespace {

using Counts = core::Image<std::uint32_t>;
using Kinds = core::Image<PixelKind>;

constexpr double kHotRateHz = 20;
constexpr double kHotEvents = 12;  // one Poisson pixel in 10^9 gets there from a mean of 1
constexpr double kHotToNeighbours = 4;

constexpr int kReachPx = 4;
constexpr int kMostNeighbours = 80;
constexpr double kCalmestShare = 0.1;
constexpr double kNoiseSpread = 4;
constexpr double kNoiseQuantile = 0.99;

/// Calls f(x, y) for every pixel up to `reach_px` away from (x0, y0), itself not.
template <class F>
void for_each_neighbour(core::Resolution size, int x0, int y0, int reach_px, F f) {
  const int last_x = std::min(x0 + reach_px, size.width_px - 1);
  const int last_y = std::min(y0 + reach_px, size.height_px - 1);
  for (int y = std::max(0, y0 - reach_px); y <= last_y; ++y)
    for (int x = std::max(0, x0 - reach_px); x <= last_x; ++x)
      if (x != x0 || y != y0) f(x, y);
}

bool is_hot(const Counts& events, int x, int y, double least_events) {
  const double own = events(x, y);
  if (own < least_events) return false;
  std::uint32_t highest = 0, second = 0;
  for_each_neighbour(events.size(), x, y, 1, [&](int nx, int ny) {
    const std::uint32_t n = events(nx, ny);
    second = std::max(second, std::min(highest, n));
    highest = std::max(highest, n);
  });
  return own > kHotToNeighbours * second;
}

void mark_hot(const Counts& events, double duration_s, Kinds& kinds) {
  const double least = std::max(kHotEvents, kHotRateHz * duration_s);
  for (int y = 0; y < events.height(); ++y)
    for (int x = 0; x < events.width(); ++x)
      if (is_hot(events, x, y, least)) kinds(x, y) = PixelKind::hot;
}

/// The neighbours of one pixel that are not hot.
struct Neighbours {
  int pixels = 0;
  std::uint64_t events = 0;

  double mean() const { return pixels > 0 ? static_cast<double>(events) / pixels : 0.0; }
};

core::Image<Neighbours> neighbours_of_all(const Counts& events, const Kinds& kinds) {
  core::Image<Neighbours> all(events.size());
  for (int y = 0; y < events.height(); ++y)
    for (int x = 0; x < events.width(); ++x)
      for_each_neighbour(events.size(), x, y, kReachPx, [&](int nx, int ny) {
        if (kinds(nx, ny) == PixelKind::hot) return;
        ++all(x, y).pixels;
        all(x, y).events += events(nx, ny);
      });
  return all;
}

/// Mean number of events of the pixels whose neighbours are the calmest.
double noise_events(const Counts& events, const Kinds& kinds,
                    const core::Image<Neighbours>& neighbours) {
  std::vector<double> means;
  means.reserve(neighbours.pixels().size());
  for (const Neighbours& each : neighbours.pixels()) means.push_back(each.mean());
  const auto calmest = means.begin() + static_cast<std::ptrdiff_t>(
                                           kCalmestShare * static_cast<double>(means.size()));
  std::nth_element(means.begin(), calmest, means.end());

  std::uint64_t sum = 0, pixels = 0;
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (kinds.pixels()[i] == PixelKind::hot || neighbours.pixels()[i].mean() > *calmest) continue;
    sum += events.pixels()[i];
    ++pixels;
  }
  return pixels > 0 ? static_cast<double>(sum) / static_cast<double>(pixels) : 0.0;
}

/// Smallest n with P(Poisson(mean) <= n) >= q. Beyond a mean of 500 by the normal law,
/// where exp(-mean) would vanish.
std::uint64_t poisson_quantile(double mean, double q) {
  if (mean > 500) {
    constexpr double kNormalQuantile = 2.3263;  // of kNoiseQuantile
    return static_cast<std::uint64_t>(std::ceil(mean + kNormalQuantile * std::sqrt(mean)));
  }
  double term = std::exp(-mean);
  double sum = term;
  std::uint64_t n = 0;
  while (sum < q) {
    ++n;
    term *= mean / static_cast<double>(n);
    sum += term;
  }
  return n;
}

void mark_quiet(const Counts& events, Kinds& kinds) {
  const core::Image<Neighbours> neighbours = neighbours_of_all(events, kinds);
  const double most_events = kNoiseSpread * noise_events(events, kinds, neighbours);
  std::array<std::uint64_t, kMostNeighbours + 1> limits{};
  for (int n = 0; n <= kMostNeighbours; ++n)
    limits[n] = poisson_quantile(most_events * n, kNoiseQuantile);
  for (std::size_t i = 0; i < kinds.pixels().size(); ++i) {
    const Neighbours& around = neighbours.pixels()[i];
    PixelKind& kind = kinds.pixels()[i];
    if (kind != PixelKind::hot && around.events <= limits[around.pixels]) kind = PixelKind::quiet;
  }
}

void check(std::span<const core::Event> events, core::Resolution size, core::Time begin,
           core::Time end) {
  if (size.width_px <= 0 || size.height_px <= 0)
    throw std::invalid_argument(
        fmt::format("sensor of {}x{} px, allowed 1x1 or more", size.width_px, size.height_px));
  if (end <= begin)
    throw std::invalid_argument(fmt::format("events from {} us to {} us, expected a later end",
                                            begin.count(), end.count()));
  core::Time last = begin;
  for (const core::Event& event : events) {
    if (event.t < last || event.t > end)
      throw std::invalid_argument(fmt::format("event at {} us, allowed {} to {}", event.t.count(),
                                              last.count(), end.count()));
    if (event.x >= size.width_px || event.y >= size.height_px)
      throw std::invalid_argument(fmt::format("event at pixel ({}, {}) of {}x{}", event.x, event.y,
                                              size.width_px, size.height_px));
    last = event.t;
  }
}

std::vector<std::int64_t> intervals_us(std::span<const core::Event> events, const Kinds& kinds) {
  constexpr core::Time kNever{INT64_MIN};
  core::Image<core::Time> last(kinds.size(), kNever);
  std::vector<std::int64_t> intervals;
  intervals.reserve(events.size());
  for (const core::Event& event : events) {
    if (kinds(event.x, event.y) == PixelKind::hot) continue;
    core::Time& before = last(event.x, event.y);
    if (before != kNever) intervals.push_back((event.t - before).count());
    before = event.t;
  }
  std::sort(intervals.begin(), intervals.end());
  return intervals;
}

}  // namespace

core::Image<PixelKind> classify_pixels(const core::Image<std::uint32_t>& events,
                                       double duration_s) {
  Kinds kinds(events.size(), PixelKind::signal);
  mark_hot(events, duration_s, kinds);
  mark_quiet(events, kinds);
  return kinds;
}

PixelActivity pixel_activity(std::span<const core::Event> events, core::Resolution size,
                             core::Time begin, core::Time end) {
  check(events, size, begin, end);
  PixelActivity activity;
  activity.duration_s = core::seconds(end - begin);
  activity.events = Counts(size);
  activity.on_events = Counts(size);
  for (const core::Event& event : events) {
    ++activity.events(event.x, event.y);
    if (event.on) ++activity.on_events(event.x, event.y);
  }
  activity.kinds = classify_pixels(activity.events, activity.duration_s);
  activity.intervals_us = intervals_us(events, activity.kinds);
  return activity;
}

}  // namespace nightjar::scenarios
