#include "scenarios/event_statistics.h"

#include <algorithm>
#include <cmath>

namespace nightjar::scenarios {
namespace {

/// The pixels of one kind, added up.
struct Sums {
  std::uint64_t pixels = 0;
  std::uint64_t events = 0;
  std::uint64_t on_events = 0;

  void add(std::uint32_t pixel_events, std::uint32_t pixel_on_events) {
    ++pixels;
    events += pixel_events;
    on_events += pixel_on_events;
  }
};

std::optional<double> ratio(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

PolarityShare polarity(const Sums& sums) {
  return {sums.events, ratio(sums.on_events, sums.events),
          ratio(sums.events - sums.on_events, sums.on_events)};
}

QuietPixels quiet_pixels(const Sums& sums, double duration_s) {
  QuietPixels quiet{sums.pixels, polarity(sums), std::nullopt, std::nullopt};
  if (sums.pixels == 0) return quiet;
  const double pixel_seconds = static_cast<double>(sums.pixels) * duration_s;
  const auto events = static_cast<double>(sums.events);
  quiet.rate_hz = events / pixel_seconds;
  quiet.rate_error_hz = std::sqrt(std::max(events, 1.0)) / pixel_seconds;
  return quiet;
}

HotPixelFigures hot_pixels(const PixelActivity& activity, const Sums& hot,
                           std::uint64_t all_events) {
  HotPixelFigures figures;
  for (int y = 0; y < activity.size().height_px; ++y)
    for (int x = 0; x < activity.size().width_px; ++x)
      if (activity.kinds(x, y) == PixelKind::hot)
        figures.pixels.push_back({x, y, activity.events(x, y) / activity.duration_s});
  std::stable_sort(figures.pixels.begin(), figures.pixels.end(),
                   [](const HotPixel& a, const HotPixel& b) { return a.rate_hz > b.rate_hz; });
  // The lower of two middle ones, as quantile() has it.
  if (!figures.pixels.empty())
    figures.rate_median_hz = figures.pixels[figures.pixels.size() / 2].rate_hz;
  figures.share_of_events = ratio(hot.events, all_events);
  return figures;
}

IntervalFigures interval_figures(std::span<const std::int64_t> intervals_us) {
  IntervalFigures figures;
  figures.intervals = intervals_us.size();
  figures.minimum_us = quantile(intervals_us, 0);
  for (std::size_t i = 0; i < kIntervalQuantiles.size(); ++i)
    figures.quantiles_us[i] = quantile(intervals_us, kIntervalQuantiles[i]);
  return figures;
}

}  // namespace

std::optional<std::int64_t> quantile(std::span<const std::int64_t> ascending, double q) {
  if (ascending.empty()) return std::nullopt;
  constexpr double kRounding = 1e-9;  // 0.1 * 30 lies just above 3
  const double rank = std::ceil(q * static_cast<double>(ascending.size()) - kRounding);
  const auto index = static_cast<std::size_t>(std::max(1.0, rank)) - 1;
  return ascending[std::min(index, ascending.size() - 1)];
}

EventStatistics event_statistics(const PixelActivity& activity) {
  Sums all, quiet, hot, signal;
  std::vector<std::int64_t> counts;
  for (std::size_t i = 0; i < activity.events.pixels().size(); ++i) {
    const std::uint32_t events = activity.events.pixels()[i];
    const std::uint32_t on_events = activity.on_events.pixels()[i];
    const PixelKind kind = activity.kinds.pixels()[i];
    all.add(events, on_events);
    (kind == PixelKind::quiet ? quiet
     : kind == PixelKind::hot ? hot
                              : signal)
        .add(events, on_events);
    counts.push_back(events);
  }
  std::sort(counts.begin(), counts.end());
  const auto rate_hz = [&](double q) {
    return static_cast<double>(*quantile(counts, q)) / activity.duration_s;
  };

  EventStatistics figures;
  figures.size = activity.size();
  figures.duration_s = activity.duration_s;
  figures.all = polarity(all);
  figures.rate_mean_hz =
      static_cast<double>(all.events) / (static_cast<double>(all.pixels) * activity.duration_s);
  figures.rate_median_hz = rate_hz(0.5);
  figures.rate_99_hz = rate_hz(0.99);
  figures.quiet = quiet_pixels(quiet, activity.duration_s);
  figures.hot = hot_pixels(activity, hot, all.events);
  figures.signal_pixels = signal.pixels;
  figures.signal = polarity(signal);
  figures.intervals = interval_figures(activity.intervals_us);
  return figures;
}

}  // namespace nightjar::scenarios
