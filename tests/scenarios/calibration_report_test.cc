#include "scenarios/calibration_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scenarios/calibration_plot.h"
#include "scenarios/intrinsics.h"
#include "tests/support/board_pictures.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Corners in every cell, 0.2 px off, and a camera known to a thousandth.
CalibrationReport good_report() {
  CalibrationReport report{"it's `odd`\n.aedat4", 120, 96, {}};
  Calibration& calibration = report.calibration;
  calibration.camera = test::distorting_camera();
  calibration.sigma = {{346, 260}, 0.3, 0.29, 0.2, 0.21, {0.002, 0.01, 1e-4, 1e-4, 0}};
  calibration.rms_px = 0.2;
  for (int k = 0; k < 9; ++k) {
    CalibratedView view;
    view.picture = std::to_string(k) + ".500 s";
    for (int i = 0; i < 48; ++i) {
      view.corner_m.emplace_back(0.03 * (i % 8), 0.03 * (i / 8));
      view.corner_px.emplace_back(20 + 43 * (i % 8) + k, 20 + 43 * (i / 8) - k);
      view.residual_px.emplace_back(0.2 * std::cos(i), 0.2 * std::sin(i));
    }
    view.rms_px = 0.2 + 0.01 * k;
    calibration.views.push_back(view);
  }
  return report;
}

TEST(CalibrationReportTest, the_scenarios_reader_takes_the_intrinsics_to_the_bit) {
  const test::ScratchFolder folder;
  CalibrationReport report = good_report();
  report.calibration.camera.fx_px = 301.0 + 1.0 / 3;
  std::ofstream(folder / "camera.yaml") << to_intrinsics_yaml(report);
  const core::CameraModel read = read_intrinsics(folder / "camera.yaml");
  const core::CameraModel& camera = report.calibration.camera;
  EXPECT_EQ(read.size, camera.size);
  EXPECT_EQ(read.fx_px, camera.fx_px);
  EXPECT_EQ(read.fy_px, camera.fy_px);
  EXPECT_EQ(read.cx_px, camera.cx_px);
  EXPECT_EQ(read.cy_px, camera.cy_px);
  EXPECT_EQ(read.lens, camera.lens);
}

TEST(CalibrationReportTest, says_how_far_each_number_is_known) {
  const std::string yaml = to_intrinsics_yaml(good_report());
  EXPECT_THAT(yaml, HasSubstr("fx_px: 301.2  # +- 0.3\n"));
  EXPECT_THAT(yaml, HasSubstr("k3: 0  # held fixed\n"));
  EXPECT_THAT(yaml, HasSubstr("9 views, rms reprojection error 0.200 px"));
  const std::string table = to_table(good_report());
  EXPECT_THAT(table, HasSubstr("120, 96 with the board"));
  EXPECT_THAT(table, HasSubstr("worst view 0.280 px (8.500 s)"));
  const auto json = nlohmann::json::parse(to_json(good_report()));
  EXPECT_EQ(json["intrinsics"]["k1"], -0.21);
  EXPECT_EQ(json["sigma"]["fx_px"], 0.3);
  EXPECT_EQ(json["views"].size(), 9u);
  EXPECT_EQ(json["views"][8]["rms_px"], 0.28);
  EXPECT_EQ(json["rms_px"], 0.2);
}

TEST(CalibrationReportTest, what_the_scenarios_reader_would_refuse_is_not_written) {
  CalibrationReport report = good_report();
  report.calibration.camera.lens.k3 = 20000;
  try {
    to_intrinsics_yaml(report);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "k3 = 20000, allowed -10000 to 10000");
  }
}

TEST(CalibrationReportTest, a_deviation_that_is_no_number_is_not_that_of_a_fixed_one) {
  CalibrationReport report = good_report();
  report.calibration.sigma.fy_px = std::nan("");
  EXPECT_THAT(to_intrinsics_yaml(report), HasSubstr("fy_px: 299.4  # not known\n"));
}

TEST(CalibrationReportTest, good_views_need_no_advice) {
  EXPECT_THAT(advice(good_report()), IsEmpty());
}

TEST(CalibrationReportTest, advises_on_each_thing_that_is_amiss) {
  CalibrationReport narrow = good_report();
  for (CalibratedView& view : narrow.calibration.views)
    for (Eigen::Vector2d& corner : view.corner_px) corner.x() = 150;
  EXPECT_THAT(advice(narrow), ElementsAre(HasSubstr("corners lie in 12 % of the picture")));
  CalibrationReport flat = good_report();
  flat.calibration.sigma.fy_px = 6;
  EXPECT_THAT(advice(flat), ElementsAre(HasSubstr("known to 2.0 % only: tilt the board")));
  CalibrationReport blurred = good_report();
  blurred.calibration.rms_px = 1.4;
  EXPECT_THAT(advice(blurred), ElementsAre(HasSubstr("corners are 1.4 px off")));
  CalibrationReport mixed = good_report();
  mixed.calibration.left_out.resize(3);
  EXPECT_THAT(advice(mixed), ElementsAre(HasSubstr("3 of 12 views do not fit")));
}

TEST(CalibrationReportTest, is_drawn_as_one_picture) {
  const std::string png = draw_png(good_report());
  ASSERT_GT(png.size(), 10000u);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_NE(png.find("IEND"), std::string::npos);
}

}  // namespace
}  // namespace nightjar::scenarios
