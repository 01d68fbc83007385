#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/image.h"
#include "core/state.h"
#include "tracker/config.h"

namespace nightjar::tracker {

/// Columns [x, x + width) and rows [y, y + height) of a picture.
struct Window {
  int x_px = 0;
  int y_px = 0;
  int width_px = 0;
  int height_px = 0;

  friend constexpr bool operator==(const Window&, const Window&) = default;
};

/// AprilTag's 36h11 detector on one thread, after a smoothing of the picture.
///
/// Same picture, same answer: nothing is kept between calls. One object serves
/// one thread at a time.
class TagDetector {
 public:
  /// Throws std::invalid_argument for a config value out of range.
  explicit TagDetector(const DetectorConfig& config);
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;

  /// All tags of the family in the picture, or in that part of it (clipped to
  /// the picture and grown to AprilTag's 4-pixel tiles), whatever their id; none
  /// that comes within 8 px of the rim of what is searched. Corners count from
  /// the whole picture's top left, pixel centres at whole numbers.
  std::vector<core::TagDetection> detect(const core::Picture& picture,
                                         std::optional<Window> window = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nightjar::tracker
