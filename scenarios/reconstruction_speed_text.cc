#include "scenarios/reconstruction_speed_text.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "scenarios/gnuplot.h"
#include "scenarios/text_table.h"

namespace nightjar::scenarios {
namespace {

using Json = nlohmann::ordered_json;  // members in the order written here

// Of Okabe and Ito's palette, which people with any colour vision can tell apart.
constexpr std::array<const char*, 8> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                 "#E69F00", "#56B4E9", "#000000", "#999933"};

std::string mega(double rate_hz) {
  return rate_hz > 0 ? fmt::format("{:.1f}", 1e-6 * rate_hz) : "-";
}

std::string ratio(double a, double b) {
  return a > 0 && b > 0 ? fmt::format("{:.2f}", a / b) : "-";
}

std::string one_table(const WorkloadSpeed& speed) {
  const MethodSpeed& reference = speed.methods.front();
  const MethodSpeed& bound = speed.methods.back();
  std::vector<std::vector<std::string>> rows = {{speed.workload, "Mev/s", "x reference", "of bound",
                                                 "with pictures: Mev/s", "x reference",
                                                 "of bound"}};
  for (const MethodSpeed& m : speed.methods)
    rows.push_back({"  " + m.method, mega(m.events_hz), ratio(m.events_hz, reference.events_hz),
                    ratio(m.events_hz, bound.events_hz), mega(m.with_pictures_hz),
                    ratio(m.with_pictures_hz, reference.with_pictures_hz),
                    ratio(m.with_pictures_hz, bound.events_hz)});
  return text_table(rows);
}

Json json(const WorkloadSpeed& speed) {
  const MethodSpeed& reference = speed.methods.front();
  const MethodSpeed& bound = speed.methods.back();
  Json methods = Json::array();
  for (const MethodSpeed& m : speed.methods)
    methods.push_back(
        {{"method", m.method},
         {"events_hz", m.events_hz},
         {"times_reference", m.events_hz / reference.events_hz},
         {"share_of_bound", m.events_hz / bound.events_hz},
         {"with_pictures_hz", m.with_pictures_hz > 0 ? Json(m.with_pictures_hz) : Json(nullptr)}});
  return {{"workload", speed.workload}, {"events", speed.events}, {"methods", methods}};
}

Json json(const MethodPictureTimes& method) {
  Json times = Json::array();
  for (const PictureTime& t : method.times)
    times.push_back({{"pictures_hz", t.rate_hz}, {"time_ms", 1e3 * t.time_s}});
  return {{"method", method.method}, {"times", times}};
}

/// "plot" of column `column` of every method's block of data.
std::string plot(const std::vector<MethodPictureTimes>& times, int column) {
  std::string curves;
  for (std::size_t i = 0; i < times.size(); ++i)
    curves += fmt::format("{}$times{} using 1:{} with linespoints lw 2 pt 7 lc rgb '{}' title {}",
                          i > 0 ? ", " : "plot ", i, column, kColours[i % kColours.size()],
                          gnuplot_text(times[i].method));
  return curves + '\n';
}

}  // namespace

std::string to_table(const std::vector<WorkloadSpeed>& speeds) {
  std::string text;
  for (const WorkloadSpeed& speed : speeds) text += one_table(speed) + '\n';
  return text;
}

std::string to_table(const std::vector<MethodPictureTimes>& times) {
  std::vector<std::vector<std::string>> rows = {{"ms a picture, at pictures/s:"}};
  for (const double rate_hz : picture_rates_hz()) rows[0].push_back(fmt::format("{}", rate_hz));
  for (const MethodPictureTimes& method : times) {
    rows.push_back({"  " + method.method});
    for (const double rate_hz : picture_rates_hz()) {
      std::string cell = "-";
      for (const PictureTime& t : method.times)
        if (t.rate_hz == rate_hz) cell = fmt::format("{:.3f}", 1e3 * t.time_s);
      rows.back().push_back(cell);
    }
  }
  return text_table(rows);
}

std::string to_json(const std::vector<WorkloadSpeed>& speeds,
                    const std::vector<MethodPictureTimes>& times) {
  Json object = {{"workloads", Json::array()}, {"picture_times", Json::array()}};
  for (const WorkloadSpeed& speed : speeds) object["workloads"].push_back(json(speed));
  for (const MethodPictureTimes& each : times) object["picture_times"].push_back(json(each));
  // A file's name may be no UTF-8; such bytes are replaced.
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string draw_picture_times(const std::string& workload,
                               const std::vector<MethodPictureTimes>& times) {
  std::string script;
  for (std::size_t i = 0; i < times.size(); ++i) {
    script += fmt::format("$times{} << EOD\n", i);
    for (const PictureTime& t : times[i].times)
      script += fmt::format("{} {} {}\n", t.rate_hz, 1e3 * t.time_s, 100 * t.time_s * t.rate_hz);
    script += "EOD\n";
  }
  script += fmt::format(
      "set encoding utf8; set terminal pngcairo noenhanced size 1600,640 font 'DejaVu Sans,13'\n"
      "set multiplot layout 1,2 title {} font ',16'\n"
      "set grid lt 1 lc rgb '#d8d8d8'; set logscale xy; set format y '%g'; set xrange [40:2500]\n"
      "set xtics (50, 100, 200, 500, 1000, 2000); set xlabel 'pictures a second'\n"
      "unset key; set ylabel 'time per picture (ms)'\n",
      gnuplot_text("Time per picture, one thread: " + workload));
  script += plot(times, 2);
  script += "set ylabel 'share of the time between pictures (%)'; set key outside right top\n";
  return run_gnuplot(script + plot(times, 3));
}

}  // namespace nightjar::scenarios
