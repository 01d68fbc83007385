#include "esi/voxel_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/events.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSensor{4, 3};

std::vector<PackedEvent> packed(const std::vector<core::Event>& events) {
  std::vector<PackedEvent> out;
  for (const core::Event& e : events) out.push_back(pack(e, kSensor.width_px));
  return out;
}

/// Bins of one pixel.
std::vector<float> bins_of(const VoxelGrid& grid, int x, int y) {
  std::vector<float> bins;
  for (int bin = 0; bin < VoxelGrid::kBins; ++bin)
    bins.push_back(grid.values[bin * grid.size.pixels() + y * grid.size.width_px + x]);
  return bins;
}

TEST(VoxelGridTest, shares_each_event_between_the_two_nearest_bins) {
  VoxelGrid grid{.size = kSensor, .values = {}};
  // 8 ms over 4 steps: 2 ms a bin, so 3 ms is bin 1.5.
  fill_voxel_grid(packed({{10ms, 0, 0, true}, {13ms, 2, 1, false}, {18ms, 3, 2, true}}), kSensor,
                  grid);
  EXPECT_EQ(bins_of(grid, 0, 0), (std::vector<float>{1, 0, 0, 0, 0}));
  EXPECT_EQ(bins_of(grid, 2, 1), (std::vector<float>{0, -0.5, -0.5, 0, 0}));
  EXPECT_EQ(bins_of(grid, 3, 2), (std::vector<float>{0, 0, 0, 0, 1}));
}

TEST(VoxelGridTest, keeps_the_sum_of_polarities_of_every_pixel) {
  VoxelGrid grid{.size = kSensor, .values = {}};
  const auto events = test::random_events(kSensor, 5000, 1s, /*seed=*/11);
  fill_voxel_grid(packed(events), kSensor, grid);
  for (int y = 0; y < kSensor.height_px; ++y)
    for (int x = 0; x < kSensor.width_px; ++x) {
      double wanted = 0, got = 0;
      for (const core::Event& e : events)
        if (e.x == x && e.y == y) wanted += e.on ? 1 : -1;
      for (const float value : bins_of(grid, x, y)) got += value;
      EXPECT_NEAR(got, wanted, 1e-3);  // some 800 float additions of about 1e-7 each
    }
}

TEST(VoxelGridTest, puts_events_of_one_moment_into_the_first_bin) {
  VoxelGrid grid{.size = kSensor, .values = {}};
  fill_voxel_grid(packed({{7ms, 1, 1, true}, {7ms, 1, 1, true}}), kSensor, grid);
  EXPECT_EQ(bins_of(grid, 1, 1), (std::vector<float>{2, 0, 0, 0, 0}));
}

TEST(VoxelGridTest, lets_the_32_bit_clock_wrap) {
  VoxelGrid wrapping{.size = kSensor, .values = {}}, plain = wrapping;
  const core::Time wrap(std::int64_t{1} << 32);
  fill_voxel_grid(packed({{wrap - 1ms, 0, 0, true}, {wrap + 3ms, 1, 1, true}}), kSensor, wrapping);
  fill_voxel_grid(packed({{0ms, 0, 0, true}, {4ms, 1, 1, true}}), kSensor, plain);
  EXPECT_EQ(wrapping.values, plain.values);
}

TEST(VoxelGridTest, lays_the_sensor_into_the_top_left_of_a_larger_grid) {
  VoxelGrid grid{.size = {6, 8}, .values = {}};
  fill_voxel_grid(packed({{1ms, 3, 2, true}}), kSensor, grid);
  EXPECT_EQ(grid.values.size(), 5u * 48u);
  EXPECT_EQ(bins_of(grid, 3, 2)[0], 1);
}

TEST(VoxelGridTest, is_empty_without_events) {
  VoxelGrid grid{.size = kSensor, .values = {3, 4}};
  fill_voxel_grid({}, kSensor, grid);
  EXPECT_EQ(grid.values, std::vector<float>(60, 0.0f));
  normalise(grid);
  EXPECT_EQ(grid.values, std::vector<float>(60, 0.0f));
}

TEST(VoxelGridTest, normalises_the_entries_that_are_not_zero_alone) {
  VoxelGrid grid{.size = {2, 1}, .values = {1, 0, 3, 0, 0, 0, 8, 0, 0, 0}};
  normalise(grid);  // mean 4, variance (9 + 1 + 16) / 3
  const double deviation = std::sqrt(26.0 / 3.0);
  EXPECT_NEAR(grid.values[0], -3 / deviation, 1e-6);  // floats
  EXPECT_NEAR(grid.values[2], -1 / deviation, 1e-6);
  EXPECT_NEAR(grid.values[6], 4 / deviation, 1e-6);
  EXPECT_EQ(grid.values[1], 0);
}

TEST(VoxelGridTest, leaves_entries_alone_that_are_all_alike) {
  VoxelGrid grid{.size = {2, 1}, .values = {0.1f, 0, 0.1f, 0, 0.1f, 0, 0, 0, 0, 0}};
  const std::vector<float> before = grid.values;
  normalise(grid);
  EXPECT_EQ(grid.values, before);
}

}  // namespace
}  // namespace nightjar::esi
