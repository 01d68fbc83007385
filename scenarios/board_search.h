#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "camera/recording.h"
#include "scenarios/calibration_board.h"
#include "scenarios/reconstruct.h"

namespace nightjar::scenarios {

/// Where the board was found.
struct BoardSearch {
  core::Resolution size;  ///< Of all pictures.
  std::uint64_t pictures = 0;
  std::vector<BoardView> views;
  std::string warning;  ///< What could not be used, in one line; empty when all was.
};

/// Called after every picture with the share that is done, 0 to 1. May throw to stop.
using SearchProgress = std::function<void(double share)>;

/// Looks in all pictures of a folder: see camera::open_frames(), which says what it throws.
BoardSearch search_pictures(const std::filesystem::path& folder, BoardFinder& finder,
                            const SearchProgress& on_progress);

/// Looks in the recording's frames of the active pixels, black around those that are smaller
/// than the sensor. Throws EmptyRecording when there are none.
BoardSearch search_frames(camera::RecordingReader& recording, BoardFinder& finder,
                          const SearchProgress& on_progress);

/// Looks in pictures of the recording's events; throws as reconstruct() does. `options` but
/// for on_progress.
BoardSearch search_events(camera::RecordingReader& recording, const ReconstructOptions& options,
                          BoardFinder& finder, const SearchProgress& on_progress);

}  // namespace nightjar::scenarios
