#include "scenarios/estimates_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <vector>

#include "tests/support/picture_records.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> all(1);
  for (const char c : line) {
    if (c == ',')
      all.emplace_back();
    else
      all.back() += c;
  }
  return all;
}

/// The rows of a CSV file as cells by column name.
std::vector<std::map<std::string, std::string>> read_table(const std::filesystem::path& path) {
  std::istringstream in(test::file_text(path));
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = cells(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> values = cells(line);
    EXPECT_EQ(values.size(), names.size()) << line;
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size() && i < values.size(); ++i) row[names[i]] = values[i];
  }
  return rows;
}

TEST(EstimatesCsv, WritesTruthBesideEstimateInOneRowAPicture) {
  const test::ScratchFolder scratch;
  OutputFolder folder(scratch.path());
  EstimatesCsv csv(folder);
  PictureRecord record = test::perfect_record(10ms);
  record.estimate.p_world_tag_m << 3.01, 1.98, 0.30000049;
  record.estimate.heading_rad = 1.5;
  record.estimate.sigma_p_m << 0.01, 0.02, 0.03;
  record.truth.turn_rate_rad_s = -0.25;
  record.vehicle.p_world_body_m.z() = 1.51;
  csv.add(test::blank_record(0us));
  csv.add(record);
  csv.finish();

  const auto rows = read_table(scratch / "estimates.csv");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].at("time_us"), "0");
  EXPECT_EQ(rows[0].at("tags_decoded"), "0");
  EXPECT_EQ(rows[0].at("estimate_valid"), "0");
  EXPECT_EQ(rows[0].at("p_world_tag_x_m"), "");
  EXPECT_EQ(rows[0].at("true_p_world_tag_x_m"), "3.000000");
  EXPECT_EQ(rows[1].at("time_us"), "10000");
  EXPECT_EQ(rows[1].at("course_phase"), "straight");
  EXPECT_EQ(rows[1].at("mission_phase"), "track");
  EXPECT_EQ(rows[1].at("tags_decoded"), "1");
  EXPECT_EQ(rows[1].at("true_p_world_uav_z_m"), "1.500000");
  EXPECT_EQ(rows[1].at("autopilot_p_world_uav_z_m"), "1.510000");
  EXPECT_EQ(rows[1].at("true_v_world_tag_y_m_s"), "0.500000");
  EXPECT_EQ(rows[1].at("true_heading_rad"), "1.570796");  // north
  EXPECT_EQ(rows[1].at("true_turn_rate_rad_s"), "-0.250000");
  EXPECT_EQ(rows[1].at("estimate_valid"), "1");
  EXPECT_EQ(rows[1].at("p_world_tag_x_m"), "3.010000");
  EXPECT_EQ(rows[1].at("p_world_tag_z_m"), "0.300000");
  EXPECT_EQ(rows[1].at("v_world_tag_y_m_s"), "0.500000");
  EXPECT_EQ(rows[1].at("heading_rad"), "1.500000");
  EXPECT_EQ(rows[1].at("sigma_p_z_m"), "0.030000");
  EXPECT_EQ(rows[1].at("last_tag_us"), "10000");
}

TEST(EstimatesCsv, HasItsNameOnlyOnceFinished) {
  const test::ScratchFolder scratch;
  OutputFolder folder(scratch.path());
  EstimatesCsv csv(folder);
  csv.add(test::blank_record(0us));
  EXPECT_FALSE(std::filesystem::exists(scratch / "estimates.csv"));
  csv.finish();
  EXPECT_TRUE(std::filesystem::exists(scratch / "estimates.csv"));
}

}  // namespace
}  // namespace nightjar::scenarios
