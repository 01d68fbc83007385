#include "scenarios/sensor_report_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include "scenarios/choice_text.h"
#include "scenarios/gnuplot.h"

namespace nightjar::scenarios {
namespace {

// Of Okabe and Ito's palette, which people with any colour vision can tell apart.
constexpr std::array<const char*, 3> kColours = {"#0072B2", "#D55E00", "#009E73"};
constexpr int kBinsPerDecade = 8;

/// A script that grows line by line.
class Script {
 public:
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_.push_back('\n');
  }
  std::string text() const { return fmt::to_string(text_); }

 private:
  fmt::memory_buffer text_;
};

constexpr double kLeastRateHz = 0.05;

/// Rate and percentage of the pixels that fire so often or more, for every rate there is;
/// before the least one all that fire at all.
void write_rates(Script& script, std::size_t i, const PixelActivity& activity) {
  std::map<std::uint32_t, std::uint64_t> pixels_by_events;
  for (const std::uint32_t events : activity.events.pixels()) ++pixels_by_events[events];
  const auto all = static_cast<double>(activity.events.pixels().size());
  auto left = all;
  const auto silent = static_cast<double>(pixels_by_events[0]);
  script.line("$rates{} << EOD\n{} {}", i, kLeastRateHz, 100 * (1 - silent / all));
  for (const auto& [events, pixels] : pixels_by_events) {
    if (events > 0) script.line("{} {}", events / activity.duration_s, 100 * left / all);
    left -= static_cast<double>(pixels);
  }
  script.line("EOD");
}

/// Left end of each bin (ms) and percentage of the intervals in it.
void write_intervals(Script& script, std::size_t i, const PixelActivity& activity) {
  std::map<int, std::uint64_t> intervals_by_bin;
  for (const std::int64_t interval : activity.intervals_us) {
    const double us = std::max(1.0, static_cast<double>(interval));
    ++intervals_by_bin[static_cast<int>(std::floor(std::log10(us) * kBinsPerDecade))];
  }
  script.line("$intervals{} << EOD", i);
  if (!intervals_by_bin.empty()) {
    const int first = intervals_by_bin.begin()->first - 1;  // with an empty bin at each end
    const int last = intervals_by_bin.rbegin()->first + 1;
    for (int bin = first; bin <= last; ++bin)
      script.line("{} {}", 1e-3 * std::pow(10.0, static_cast<double>(bin) / kBinsPerDecade),
                  100 * static_cast<double>(intervals_by_bin[bin]) /
                      static_cast<double>(activity.intervals_us.size()));
  }
  script.line("EOD");
}

/// Place on the axis and ON share (%) of all, quiet and signal pixels' events.
void write_on_shares(Script& script, std::size_t i, std::size_t columns,
                     const EventStatistics& statistics) {
  const std::array<std::optional<double>, 3> shares = {
      statistics.all.on_share, statistics.quiet.polarity.on_share, statistics.signal.on_share};
  const double middle = 0.5 * static_cast<double>(columns - 1);
  script.line("$on{} << EOD", i);
  for (std::size_t group = 0; group < shares.size(); ++group)
    if (shares[group])
      script.line("{} {}", static_cast<double>(group) + 0.26 * (static_cast<double>(i) - middle),
                  100 * *shares[group]);
  script.line("EOD");
}

/// The rates, row by row, and the places of the hot pixels.
void write_map(Script& script, std::size_t i, const ReportColumn& column) {
  const PixelActivity& activity = column.activity;
  script.line("$map{} << EOD", i);
  for (int y = 0; y < activity.size().height_px; ++y) {
    std::string row;
    for (int x = 0; x < activity.size().width_px; ++x) {
      const std::uint32_t events = activity.events(x, y);
      row += events > 0 ? fmt::format("{:.4g} ", events / activity.duration_s) : "NaN ";
    }
    script.line("{}", row);
  }
  script.line("EOD\n$hot{} << EOD", i);
  for (const HotPixel& pixel : column.statistics.hot.pixels) script.line("{} {}", pixel.x, pixel.y);
  script.line("EOD");
}

/// "plot" with one curve for each column, of the blocks `name`0, `name`1, ...
void plot_columns(Script& script, std::size_t columns, const char* name, const char* style) {
  std::string curves;
  for (std::size_t i = 0; i < columns; ++i)
    curves += fmt::format("{}${}{} using 1:2 with {} lw 2.5 lc rgb '{}'", i > 0 ? ", " : "", name,
                          i, style, kColours[i]);
  script.line("plot {}", curves);
}

void plot_rates(Script& script, std::size_t columns) {
  script.line("set title 'How often pixels fire'");
  script.line("set xlabel 'rate r of a pixel (Hz)'");
  script.line("set ylabel 'pixels that fire at r or more (%)'");
  script.line("set logscale xy; set format '%g'; set yrange [5e-4:200]; set xrange [{}:*]",
              kLeastRateHz);
  plot_columns(script, columns, "rates", "fsteps");
}

void plot_intervals(Script& script, std::size_t columns) {
  script.line("set title 'Time between two events of a pixel, hot pixels aside'");
  script.line("set xlabel 'interval (ms)'");
  script.line("set ylabel 'intervals in a bin, {} bins a decade (%)'", kBinsPerDecade);
  script.line("unset logscale y; set yrange [0:*]; set xrange [1e-3:1e5]; set xtics 100");
  plot_columns(script, columns, "intervals", "steps");
}

void plot_on_shares(Script& script, std::size_t columns) {
  script.line("set title 'Polarity'");
  script.line("unset xlabel; set ylabel 'ON events (%)'");
  script.line("unset logscale x; set xrange [-0.6:2.6]; set yrange [0:110]");
  script.line("set xtics ('all pixels' 0, 'quiet pixels' 1, 'signal pixels' 2)");
  script.line("set ytics 0,25,100; set boxwidth 0.23; set style fill solid 0.85 noborder");
  std::string curves = "50 with lines dt 2 lc rgb '#808080'";
  for (std::size_t i = 0; i < columns; ++i)
    curves += fmt::format(
        ", $on{0} using 1:2 with boxes lc rgb '{1}', $on{0} using 1:2:(sprintf('%.0f', $2)) with "
        "labels offset 0,0.6 font ',11'",
        i, kColours[i]);
  script.line("plot {}", curves);
}

void set_up_maps(Script& script) {
  script.line("unset xtics; unset ytics; unset grid; unset ylabel");
  script.line("set size ratio -1; set logscale cb; set cbrange [0.1:1000]; set format cb '%g'");
  script.line("set cblabel 'rate of a pixel (Hz)'");
  script.line(
      "set palette defined (0 '#1b0c41', 1 '#781c6d', 2 '#cf4446', 3 '#fb9b06', 4 '#fcffa4')");
  script.line("set object 1 rectangle from graph 0,0 to graph 1,1 behind fc rgb 'black'");
}

void plot_map(Script& script, std::size_t i, const ReportColumn& column) {
  const core::Resolution size = column.activity.size();
  script.line("set title {} textcolor rgb '{}'", gnuplot_text(column.name), kColours[i]);
  script.line("set xlabel '{}x{} px, {:.3g} s; black: no event; rings: {} hot pixels'",
              size.width_px, size.height_px, column.activity.duration_s,
              column.statistics.hot.pixels.size());
  script.line("set xrange [-0.5:{}]; set yrange [{}:-0.5]", size.width_px - 0.5,
              size.height_px - 0.5);
  script.line(
      "plot $map{0} matrix with image, $hot{0} using 1:2 with points pt 6 ps 1.6 lw 1.5 lc rgb "
      "'#56B4E9'",
      i);
}

/// One legend for all axes, under the heading.
void write_legend(Script& script, const SensorReport& report) {
  const std::size_t columns = report.columns.size();
  for (std::size_t i = 0; i < columns; ++i)
    script.line("set label {} {} at screen {},0.945 center textcolor rgb '{}' font ',15'", i + 1,
                gnuplot_text("— " + report.columns[i].name), (static_cast<double>(i) + 0.5) / 3,
                kColours[i]);
}

std::string heading(const SensorReportConfig& config) {
  return fmt::format("Event sensor: preset {}, {} lux, seed {}, texture at {} px/s",
                     choice_name(config.sensor.preset, sim::kSensorPresets),
                     core::number_text(config.illuminance_lux), config.seed,
                     core::number_text(config.speed_px_s));
}

}  // namespace

std::string draw_png(const SensorReport& report) {
  Script script;
  const std::size_t columns = report.columns.size();
  for (std::size_t i = 0; i < columns; ++i) {
    const ReportColumn& column = report.columns[i];
    write_rates(script, i, column.activity);
    write_intervals(script, i, column.activity);
    write_on_shares(script, i, columns, column.statistics);
    write_map(script, i, column);
  }
  script.line("set encoding utf8; unset key");
  script.line("set terminal pngcairo noenhanced size 1800,1080 font 'DejaVu Sans,13'");
  script.line("set multiplot layout 2,3 margins 0.065,0.93,0.06,0.88 spacing 0.085,0.13");
  script.line("set label 10 {} at screen 0.5,0.98 center font ',17'",
              gnuplot_text(heading(report.config)));
  script.line("set grid lt 1 lc rgb '#d8d8d8'; set xtics nomirror; set ytics nomirror");
  write_legend(script, report);
  plot_rates(script, columns);
  script.line("unset label");
  plot_intervals(script, columns);
  plot_on_shares(script, columns);
  set_up_maps(script);
  for (std::size_t i = 0; i < columns; ++i) plot_map(script, i, report.columns[i]);
  script.line("unset multiplot");
  return run_gnuplot(script.text());
}

}  // namespace nightjar::scenarios
