#pragma once

#include <filesystem>
#include <memory>

#include "core/image.h"

namespace nightjar::scenarios {

/// The number of frames that can be read; 0 when the file is no video.
int video_frames(const std::filesystem::path& path);

/// A video (MP4, H.264) of grey pictures, which has its name once it is complete. Odd sides
/// grow by one, black, as the codec takes even ones only.
class GrayVideo {
 public:
  /// Throws std::runtime_error when no video can be written there.
  GrayVideo(std::filesystem::path path, core::Resolution size, double rate_hz);

  /// Removes what was not finished.
  ~GrayVideo();

  void add(const core::Image<std::uint8_t>& gray);

  /// Gives the file its name. Throws std::runtime_error unless it reads back with every
  /// picture that was added, one at least.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nightjar::scenarios
