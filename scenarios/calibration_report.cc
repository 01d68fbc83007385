#include "scenarios/calibration_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/config_check.h"
#include "scenarios/scenario_error.h"

namespace nightjar::scenarios {
namespace {

constexpr double kLeastCovered = 0.8;
constexpr double kMostFocalSigma = 0.01;
constexpr double kMostRms_px = 1;
constexpr double kMostLeftOut = 0.2;

struct Number {
  const char* name;
  double value, sigma;
};

/// All that is estimated, in the file's order.
std::array<Number, 9> numbers(const Calibration& calibration) {
  const core::CameraModel &c = calibration.camera, &s = calibration.sigma;
  return {{{"fx_px", c.fx_px, s.fx_px},
           {"fy_px", c.fy_px, s.fy_px},
           {"cx_px", c.cx_px, s.cx_px},
           {"cy_px", c.cy_px, s.cy_px},
           {"k1", c.lens.k1, s.lens.k1},
           {"k2", c.lens.k2, s.lens.k2},
           {"p1", c.lens.p1, s.lens.p1},
           {"p2", c.lens.p2, s.lens.p2},
           {"k3", c.lens.k3, s.lens.k3}}};
}

std::string sigma_text(double sigma) {
  return sigma > 0 ? fmt::format("+- {:.2g}", sigma) : "held fixed";
}

const CalibratedView& worst(const Calibration& calibration) {
  return *std::ranges::max_element(calibration.views, {}, &CalibratedView::rms_px);
}

}  // namespace

std::string to_intrinsics_yaml(const CalibrationReport& report) {
  const Calibration& calibration = report.calibration;
  std::string text = fmt::format(
      "# Camera intrinsics from {} views, rms reprojection error {:.3f} px (nightjar calibrate).\n"
      "# Pixel centres at whole numbers; OpenCV's distortion model; +- one standard deviation.\n"
      "width_px: {}\nheight_px: {}\n",
      calibration.views.size(), calibration.rms_px, calibration.camera.size.width_px,
      calibration.camera.size.height_px);
  for (const Number& number : numbers(calibration))
    text += fmt::format("{}: {}  # {}\n", number.name, number.value, sigma_text(number.sigma));
  return text;
}

std::string to_table(const CalibrationReport& report) {
  const Calibration& calibration = report.calibration;
  const auto row = [](const char* name, const std::string& value) {
    return fmt::format("  {:<14}{}\n", name, value);
  };
  std::string table = fmt::format("{}\n", shown_file(report.source));
  table += row("pictures", fmt::format("{}, {} with the board", report.pictures, report.boards));
  table += row("views used", fmt::format("{}, {} more left out as misfits",
                                         calibration.views.size(), calibration.left_out.size()));
  for (const Number& number : numbers(calibration))
    table += row(number.name, fmt::format("{:>10.5g} {}", number.value, sigma_text(number.sigma)));
  table += row("covered", fmt::format("{:.0f} % of the picture", 100 * calibration.covered()));
  table += row("rms error", fmt::format("{:.3f} px; worst view {:.3f} px ({})", calibration.rms_px,
                                        worst(calibration).rms_px, worst(calibration).picture));
  for (const CalibratedView& view : calibration.views)
    table += row("", fmt::format("{:<14}{:>4} corners {:>7.3f} px", view.picture,
                                 view.corner_px.size(), view.rms_px));
  return table;
}

std::string to_json(const CalibrationReport& report) {
  using Json = nlohmann::ordered_json;
  const Calibration& calibration = report.calibration;
  Json json = {{"source", shown_file(report.source)},
               {"pictures", report.pictures},
               {"pictures_with_board", report.boards},
               {"width_px", calibration.camera.size.width_px},
               {"height_px", calibration.camera.size.height_px}};
  for (const Number& number : numbers(calibration)) {
    json["intrinsics"][number.name] = number.value;
    json["sigma"][number.name] = number.sigma;
  }
  json["rms_px"] = calibration.rms_px;
  json["covered"] = calibration.covered();
  json["views"] = Json::array();
  for (const CalibratedView& view : calibration.views)
    json["views"].push_back(
        {{"picture", view.picture}, {"corners", view.corner_px.size()}, {"rms_px", view.rms_px}});
  json["left_out"] = Json::array();
  for (const BoardView& view : calibration.left_out) json["left_out"].push_back(view.picture);
  json["advice"] = advice(report);
  return json.dump(2) + '\n';
}

std::vector<std::string> advice(const CalibrationReport& report) {
  const Calibration& calibration = report.calibration;
  const core::CameraModel &camera = calibration.camera, &sigma = calibration.sigma;
  std::vector<std::string> lines;
  if (const double covered = calibration.covered(); covered < kLeastCovered)
    lines.push_back(fmt::format(
        "corners lie in {:.0f} % of the picture: show the board in all of its corners, too",
        100 * covered));
  const double focal = std::max(sigma.fx_px / camera.fx_px, sigma.fy_px / camera.fy_px);
  if (focal > kMostFocalSigma)
    lines.push_back(fmt::format(
        "the focal length is known to {:.1f} % only: tilt the board more, show it near and far",
        100 * focal));
  if (calibration.rms_px > kMostRms_px)
    lines.push_back(fmt::format(
        "corners are {:.1f} px off: is the board flat, the picture sharp, the board as described?",
        calibration.rms_px));
  const auto left_out = static_cast<double>(calibration.left_out.size());
  if (left_out > kMostLeftOut * (left_out + static_cast<double>(calibration.views.size())))
    lines.push_back(fmt::format("{} of {} views do not fit the others", calibration.left_out.size(),
                                calibration.left_out.size() + calibration.views.size()));
  return lines;
}

}  // namespace nightjar::scenarios
