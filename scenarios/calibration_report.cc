#include "scenarios/calibration_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/config_check.h"
#include "scenarios/intrinsics.h"
#include "scenarios/intrinsics_config.h"
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

/// Gathers what a fit estimates: all members but the size.
struct Estimates {
  std::vector<std::pair<const char*, double>> all;

  void field(const char* name, const double& value, double, double, const core::Origin& = {}) {
    all.emplace_back(name, value);
  }
  void field(const char*, const int&, int, int, const core::Origin& = {}) {}
};

/// In the file's order.
std::vector<Number> numbers(const Calibration& calibration) {
  IntrinsicsConfig camera = intrinsics_of(calibration.camera);
  IntrinsicsConfig sigma = intrinsics_of(calibration.sigma);
  Estimates values, sigmas;
  camera.visit(values);
  sigma.visit(sigmas);
  std::vector<Number> numbers;
  for (std::size_t i = 0; i < values.all.size(); ++i)
    numbers.push_back({values.all[i].first, values.all[i].second, sigmas.all[i].second});
  return numbers;
}

std::string sigma_text(double sigma) {
  if (sigma == 0) return "held fixed";
  return sigma > 0 ? fmt::format("+- {:.2g}", sigma) : "not known";
}

const CalibratedView& worst(const Calibration& calibration) {
  return *std::ranges::max_element(calibration.views, {}, &CalibratedView::rms_px);
}

}  // namespace

std::string to_intrinsics_yaml(const CalibrationReport& report) {
  const Calibration& calibration = report.calibration;
  const IntrinsicsConfig intrinsics = intrinsics_of(calibration.camera);
  core::check_config(intrinsics, "");
  std::string text = fmt::format(
      "# Camera intrinsics from {} views, rms reprojection error {:.3f} px (nightjar calibrate).\n"
      "# Pixel centres at whole numbers; OpenCV's distortion model; +- one standard deviation.\n"
      "width_px: {}\nheight_px: {}\n",
      calibration.views.size(), calibration.rms_px, intrinsics.width_px, intrinsics.height_px);
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
