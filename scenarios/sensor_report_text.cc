#include "scenarios/sensor_report_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scenarios/choice_text.h"

namespace nightjar::scenarios {
namespace {

using Json = nlohmann::ordered_json;  // members in the order written here
using Cell = std::string (*)(const ReportColumn&);

template <class T>
std::string text(const std::optional<T>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::string milliseconds(const std::optional<std::int64_t>& us) {
  return us ? fmt::format("{:.3f} ms", static_cast<double>(*us) / 1000) : "-";
}

std::string delay(const std::optional<core::Time>& time) {
  return time ? milliseconds(time->count()) : "-";
}

std::string rate(const QuietPixels& quiet) {
  if (!quiet.rate_hz) return "-";
  return fmt::format("{:.4f} ± {:.4f} Hz", *quiet.rate_hz, *quiet.rate_error_hz);
}

std::string rates(const HotPixelFigures& hot) {
  if (hot.pixels.empty()) return "-";
  return fmt::format("{:.0f} / {:.0f} / {:.0f} Hz", hot.pixels.back().rate_hz, *hot.rate_median_hz,
                     hot.pixels.front().rate_hz);
}

template <std::size_t I>
std::string interval(const ReportColumn& c) {
  return milliseconds(c.statistics.intervals.quantiles_us[I]);
}

struct Row {
  const char* name;
  Cell cell;
};

const Row kRows[] = {
    {"sensor",
     [](const ReportColumn& c) {
       return fmt::format("{}x{} px", c.statistics.size.width_px, c.statistics.size.height_px);
     }},
    {"duration",
     [](const ReportColumn& c) { return fmt::format("{:.3f} s", c.statistics.duration_s); }},
    {"events", [](const ReportColumn& c) { return fmt::format("{}", c.statistics.all.events); }},
    {"  lost in the readout", [](const ReportColumn& c) { return text(c.lost_events, "{}"); }},
    {"  greatest delay there", [](const ReportColumn& c) { return delay(c.max_delay); }},
    {"  ON share", [](const ReportColumn& c) { return text(c.statistics.all.on_share, "{:.3f}"); }},
    {"  OFF per ON",
     [](const ReportColumn& c) { return text(c.statistics.all.off_per_on, "{:.2f}"); }},
    {"rate of a pixel, mean",
     [](const ReportColumn& c) { return fmt::format("{:.4f} Hz", c.statistics.rate_mean_hz); }},
    {"  median",
     [](const ReportColumn& c) { return fmt::format("{:.4f} Hz", c.statistics.rate_median_hz); }},
    {"  99 % of the pixels up to",
     [](const ReportColumn& c) { return fmt::format("{:.4f} Hz", c.statistics.rate_99_hz); }},
    {"quiet pixels",
     [](const ReportColumn& c) { return fmt::format("{}", c.statistics.quiet.pixels); }},
    {"  rate", [](const ReportColumn& c) { return rate(c.statistics.quiet); }},
    {"  ON share",
     [](const ReportColumn& c) { return text(c.statistics.quiet.polarity.on_share, "{:.3f}"); }},
    {"signal pixels",
     [](const ReportColumn& c) { return fmt::format("{}", c.statistics.signal_pixels); }},
    {"  ON share",
     [](const ReportColumn& c) { return text(c.statistics.signal.on_share, "{:.3f}"); }},
    {"  OFF per ON",
     [](const ReportColumn& c) { return text(c.statistics.signal.off_per_on, "{:.2f}"); }},
    {"hot pixels",
     [](const ReportColumn& c) { return fmt::format("{}", c.statistics.hot.pixels.size()); }},
    {"  least / median / most", [](const ReportColumn& c) { return rates(c.statistics.hot); }},
    {"  share of all events",
     [](const ReportColumn& c) { return text(c.statistics.hot.share_of_events, "{:.4f}"); }},
    {"interval, shortest",
     [](const ReportColumn& c) { return milliseconds(c.statistics.intervals.minimum_us); }},
    {"  0.1 %", interval<0>},
    {"  1 %", interval<1>},
    {"  10 %", interval<2>},
    {"  50 %", interval<3>},
    {"  90 %", interval<4>},
    {"  99 %", interval<5>},
};
static_assert(kIntervalQuantiles == std::array{0.001, 0.01, 0.1, 0.5, 0.9, 0.99});

std::string heading(const SensorReportConfig& config) {
  return fmt::format("preset {}, {} lux, seed {}; grey bars at rest, then a texture at {} px/s\n\n",
                     choice_name(config.sensor.preset, sim::kSensorPresets),
                     core::number_text(config.illuminance_lux), config.seed,
                     core::number_text(config.speed_px_s));
}

/// Number of characters of UTF-8 text.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string right_aligned(const std::string& text, std::size_t to_width) {
  return std::string(to_width - std::min(to_width, width(text)), ' ') + text;
}

template <class T>
Json json(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json(const PolarityShare& polarity) {
  return {{"events", polarity.events},
          {"on_share", json(polarity.on_share)},
          {"off_per_on", json(polarity.off_per_on)}};
}

Json json(const QuietPixels& quiet) {
  return {{"pixels", quiet.pixels},
          {"events", quiet.polarity.events},
          {"rate_hz", json(quiet.rate_hz)},
          {"rate_error_hz", json(quiet.rate_error_hz)},
          {"on_share", json(quiet.polarity.on_share)}};
}

Json json(const HotPixelFigures& hot) {
  Json pixels = Json::array();
  for (const HotPixel& pixel : hot.pixels)
    pixels.push_back({{"x", pixel.x}, {"y", pixel.y}, {"rate_hz", pixel.rate_hz}});
  return {{"share_of_events", json(hot.share_of_events)},
          {"rate_median_hz", json(hot.rate_median_hz)},
          {"pixels", pixels}};
}

Json json(const IntervalFigures& intervals) {
  Json quantiles = Json::array();
  for (std::size_t i = 0; i < kIntervalQuantiles.size(); ++i)
    quantiles.push_back(
        {{"share", kIntervalQuantiles[i]}, {"interval_us", json(intervals.quantiles_us[i])}});
  return {{"intervals", intervals.intervals},
          {"minimum_us", json(intervals.minimum_us)},
          {"quantiles", quantiles}};
}

Json json(const ReportColumn& column) {
  const EventStatistics& s = column.statistics;
  Json signal = json(s.signal);
  signal["pixels"] = s.signal_pixels;
  return {{"name", column.name},
          {"width_px", s.size.width_px},
          {"height_px", s.size.height_px},
          {"duration_s", s.duration_s},
          {"lost_events", json(column.lost_events)},
          {"max_delay_us", column.max_delay ? Json(column.max_delay->count()) : Json(nullptr)},
          {"all", json(s.all)},
          {"rate_mean_hz", s.rate_mean_hz},
          {"rate_median_hz", s.rate_median_hz},
          {"rate_99_hz", s.rate_99_hz},
          {"quiet", json(s.quiet)},
          {"signal", signal},
          {"hot", json(s.hot)},
          {"intervals", json(s.intervals)}};
}

}  // namespace

std::string to_table(const SensorReport& report) {
  std::vector<std::size_t> widths;
  std::string lines = fmt::format("{:28}", "");
  for (const ReportColumn& column : report.columns) {
    widths.push_back(std::max<std::size_t>(24, width(column.name) + 2));
    lines += right_aligned(column.name, widths.back());
  }
  lines += '\n';
  for (const Row& row : kRows) {
    lines += fmt::format("{:28}", row.name);
    for (std::size_t i = 0; i < report.columns.size(); ++i)
      lines += right_aligned(row.cell(report.columns[i]), widths[i]);
    lines += '\n';
  }
  return heading(report.config) + lines;
}

std::string to_json(const SensorReport& report) {
  Json columns = Json::array();
  for (const ReportColumn& column : report.columns) columns.push_back(json(column));
  const SensorReportConfig& config = report.config;
  const Json object = {{"preset", choice_name(config.sensor.preset, sim::kSensorPresets)},
                       {"illuminance_lux", config.illuminance_lux},
                       {"seed", config.seed},
                       {"speed_px_s", config.speed_px_s},
                       {"columns", columns}};
  // A file's name may be no UTF-8; such bytes are replaced.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace nightjar::scenarios
