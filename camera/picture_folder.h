#pragma once

#include <vector>

#include "camera/frame_source.h"
#include "camera/picture_converter.h"

namespace nightjar::camera {

/// Whether the name ends as that of a picture we read: .png, .tif, .exr, ...
bool is_picture(const std::filesystem::path& path);

/// Pictures as frames: see open_frames(). Other files in the folder, hidden ones and
/// subfolders are passed over. One picture at a time is in memory.
class PictureFolder : public FrameSource {
 public:
  PictureFolder(const std::filesystem::path& folder, const FrameOptions& options);

  bool next(core::Image<float>& intensity) override;
  double rate_hz() const override { return rate_hz_; }
  int announced_frames() const override { return static_cast<int>(pictures_.size()); }
  std::uint64_t bad_values() const override { return converter_.bad_values(); }

 private:
  double rate_hz_ = 0;
  std::vector<std::filesystem::path> pictures_;
  std::size_t next_ = 0;
  PictureConverter converter_;
};

}  // namespace nightjar::camera
