#pragma once

#include <string>
#include <utility>
#include <vector>

#include "camera/recording.h"

namespace nightjar::test {

/// A recording that is the parts it was given.
class FakeRecording : public camera::RecordingReader {
 public:
  FakeRecording(core::Resolution size, std::vector<camera::RecordingPart> parts)
      : size_(size), parts_(std::move(parts)) {}

  std::string format() const override { return "fake"; }
  std::string camera() const override { return {}; }
  core::Resolution size() const override { return size_; }
  bool next(camera::RecordingPart& part) override {
    if (next_ == parts_.size()) return false;
    part = parts_[next_++];
    return true;
  }
  double progress() const override {
    return static_cast<double>(next_) / static_cast<double>(parts_.size());
  }
  const camera::RecordingFaults& faults() const override { return faults_; }

  camera::RecordingFaults faults_;

 private:
  core::Resolution size_;
  std::vector<camera::RecordingPart> parts_;
  std::size_t next_ = 0;
};

/// A frame of one grey level.
inline core::ApsFrame flat_frame(core::Resolution size, core::Time begin, core::Time end,
                                 std::uint16_t level) {
  return {.exposure_begin = begin,
          .exposure_end = end,
          .bits = 8,
          .gray = core::Image<std::uint16_t>(size, level)};
}

}  // namespace nightjar::test
