#pragma once

#include <memory>
#include <string>

#include "camera/frame_source.h"
#include "camera/picture_converter.h"

namespace nightjar::camera {

/// The frames of a video, whatever OpenCV decodes: see open_frames(). The frames are
/// taken as evenly spaced.
class VideoFile : public FrameSource {
 public:
  VideoFile(const std::filesystem::path& path, const FrameOptions& options);
  ~VideoFile() override;

  bool next(core::Image<float>& intensity) override;
  double rate_hz() const override { return rate_hz_; }
  int announced_frames() const override { return announced_frames_; }
  std::uint64_t bad_values() const override { return converter_.bad_values(); }

 private:
  struct Decoder;

  std::string name_;
  std::unique_ptr<Decoder> decoder_;
  double rate_hz_ = 0;
  int announced_frames_ = 0;
  PictureConverter converter_;
};

}  // namespace nightjar::camera
