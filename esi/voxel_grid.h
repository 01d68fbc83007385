#pragma once

#include <span>
#include <vector>

#include "core/event.h"
#include "esi/packed_event.h"

namespace nightjar::esi {

/// Events as the networks see them: planes of equal time steps from the first event to
/// the last, each event shared between the two planes nearest to it.
struct VoxelGrid {
  static constexpr int kBins = 5;

  core::Resolution size;      ///< Of a plane; at least the sensor's, which lies top left.
  std::vector<float> values;  ///< kBins planes, each row-major.
};

/// Fills `grid`, whose size is set: an event adds +1 (ON) or -1 (OFF) to its pixel, split
/// linearly in time (E2VID, section 3.2; the time scale is kBins - 1 over the time from the
/// first event to the last). `events` are ordered by time, packed for `sensor`, and the
/// last less than 2^32 us after the first.
void fill_voxel_grid(std::span<const PackedEvent> events, core::Resolution sensor, VoxelGrid& grid);

/// Gives the entries that are not 0 a mean of 0 and a deviation of 1, as E2VID does; left
/// alone where they are all alike.
void normalise(VoxelGrid& grid);

}  // namespace nightjar::esi
