#include "scenarios/calibration_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "scenarios/gnuplot.h"

namespace nightjar::scenarios {
namespace {

constexpr const char* kBlue = "#0072B2";  // of Okabe and Ito's palette
constexpr const char* kRed = "#D55E00";
constexpr int kGridSteps = 16;  // across the width, where the lens is shown

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

/// x, y, dx, dy of every corner.
void write_corners(Script& script, const Calibration& calibration) {
  script.line("$corners << EOD");
  for (const CalibratedView& view : calibration.views)
    for (std::size_t i = 0; i < view.corner_px.size(); ++i)
      script.line("{:.3f} {:.3f} {:.5f} {:.5f}", view.corner_px[i].x(), view.corner_px[i].y(),
                  view.residual_px[i].x(), view.residual_px[i].y());
  script.line("EOD");
}

void write_views(Script& script, const Calibration& calibration) {
  script.line("$views << EOD");
  for (std::size_t i = 0; i < calibration.views.size(); ++i)
    script.line("{} {:.5f}", i + 1, calibration.views[i].rms_px);
  script.line("EOD");
}

/// x, y where a pinhole would show things and dx, dy to where this lens does; the greatest.
double write_lens(Script& script, const core::CameraModel& camera) {
  double most_px = 0;
  script.line("$lens << EOD");
  const double step_px = static_cast<double>(camera.size.width_px) / kGridSteps;
  for (double y = step_px / 2; y < camera.size.height_px; y += step_px)
    for (double x = step_px / 2; x < camera.size.width_px; x += step_px) {
      const Eigen::Vector2d seen(x, y), pinhole = camera.undistorted(seen);
      most_px = std::max(most_px, (seen - pinhole).norm());
      script.line("{:.2f} {:.2f} {:.3f} {:.3f}", pinhole.x(), pinhole.y(), x - pinhole.x(),
                  y - pinhole.y());
    }
  script.line("EOD");
  return most_px;
}

/// Axes of the sensor, y down, with some space around.
void sensor_axes(Script& script, core::Resolution size) {
  script.line("set size ratio -1; set xlabel 'x (px)'; set ylabel 'y (px)'");
  script.line("set xrange [{}:{}]; set yrange [{}:{}]", -0.05 * size.width_px, 1.05 * size.width_px,
              1.05 * size.height_px, -0.05 * size.height_px);
  script.line(
      "set object 1 rectangle from -0.5,-0.5 to {},{} behind fs empty border lc rgb '#404040'",
      size.width_px - 0.5, size.height_px - 0.5);
}

/// A twentieth of the picture's width stands for three times the rms.
double enlargement(const Calibration& calibration) {
  const double wanted =
      calibration.camera.size.width_px / 60.0 / std::max(calibration.rms_px, 1e-6);
  const double decade = std::pow(10, std::floor(std::log10(wanted)));
  return decade * std::max(1.0, std::floor(wanted / decade));
}

/// Tints the cells of the picture in which no corner lies.
void mark_empty_cells(Script& script, const Calibration& calibration) {
  const double width_px = static_cast<double>(calibration.camera.size.width_px) / kCellColumns;
  const double height_px = static_cast<double>(calibration.camera.size.height_px) / kCellRows;
  const auto cells = calibration.cells();
  for (int i = 0; i < kCellColumns * kCellRows; ++i) {
    if (cells[static_cast<std::size_t>(i)]) continue;
    const double x = i % kCellColumns * width_px - 0.5, y = i / kCellColumns * height_px - 0.5;
    script.line("set object {} rectangle from {},{} to {},{} behind fc rgb '#f6d5c3' fs noborder",
                i + 2, x, y, x + width_px, y + height_px);
  }
}

void plot_corners(Script& script, const Calibration& calibration) {
  const double times = enlargement(calibration);
  script.line("set title 'Corners: in {:.0f} % of the cells (tinted: none); residuals {:g} times'",
              100 * calibration.covered(), times);
  mark_empty_cells(script, calibration);
  sensor_axes(script, calibration.camera.size);
  script.line(
      "plot $corners using 1:2 with points pt 7 ps 0.35 lc rgb '{}', "
      "$corners using 1:2:($3*{}):($4*{}) with vectors nohead lw 1 lc rgb '{}'",
      kBlue, times, times, kRed);
}

void plot_residuals(Script& script, const Calibration& calibration) {
  const double most_px = 4 * std::max(calibration.rms_px, 1e-6);
  script.line("set title 'Residuals, seen - projected: rms {:.3f} px'", calibration.rms_px);
  script.line("unset object; set xlabel 'dx (px)'; set ylabel 'dy (px)'");
  script.line("set xrange [{}:{}]; set yrange [{}:{}]", -most_px, most_px, most_px, -most_px);
  script.line("plot $corners using 3:4 with points pt 7 ps 0.4 lc rgb '{}'", kBlue);
}

void plot_views(Script& script, const Calibration& calibration) {
  script.line("set title '{} views, {} left out: rms of each'", calibration.views.size(),
              calibration.left_out.size());
  script.line("set size noratio; set xlabel 'view'; set ylabel 'rms (px)'");
  script.line("set xrange [0:{}]; set yrange [0:*]", calibration.views.size() + 1);
  script.line("set boxwidth 0.8; set style fill solid 0.85 noborder");
  script.line("plot $views with boxes lc rgb '{}', {} with lines dt 2 lc rgb '{}'", kBlue,
              calibration.rms_px, kRed);
}

void plot_lens(Script& script, const Calibration& calibration, double most_px) {
  script.line("set title 'The lens: from a pinhole''s place to the seen one, {:.1f} px at most'",
              most_px);
  sensor_axes(script, calibration.camera.size);
  script.line(
      "plot $lens using 1:2:3:4 with vectors filled lw 1.2 lc rgb '{}', "
      "'-' with points pt 2 ps 1.5 lw 2 lc rgb '{}'\n{} {}\ne",
      kBlue, kRed, calibration.camera.cx_px, calibration.camera.cy_px);
}

}  // namespace

std::string draw_png(const CalibrationReport& report) {
  const Calibration& calibration = report.calibration;
  Script script;
  write_corners(script, calibration);
  write_views(script, calibration);
  const double most_px = write_lens(script, calibration.camera);
  script.line("set encoding utf8; unset key");
  script.line("set terminal pngcairo noenhanced size 1500,1180 font 'DejaVu Sans,13'");
  script.line("set multiplot layout 2,2 margins 0.065,0.97,0.06,0.9 spacing 0.09,0.12");
  script.line("set label 10 {} at screen 0.5,0.97 center font ',17'",
              gnuplot_text("Calibration: " + report.source));
  script.line("set grid lt 1 lc rgb '#d8d8d8'; set xtics nomirror; set ytics nomirror");
  plot_corners(script, calibration);
  script.line("unset label");
  plot_residuals(script, calibration);
  plot_views(script, calibration);
  plot_lens(script, calibration, most_px);
  script.line("unset multiplot");
  return run_gnuplot(script.text());
}

}  // namespace nightjar::scenarios
