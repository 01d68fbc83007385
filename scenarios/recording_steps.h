#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "camera/recording.h"
#include "scenarios/step_reader.h"

namespace nightjar::scenarios {

/// A camera's recording as a camera would have sent it: every 10 ms the events, IMU samples
/// and frames since then. Of those that events keep waiting for long, the latest are held.
class RecordingSteps : public StepReader {
 public:
  explicit RecordingSteps(std::unique_ptr<camera::RecordingReader> recording);

  std::optional<core::Time> next(msg::Bus& bus) override;
  bool has_vehicle_states() const override { return false; }
  double progress() const override { return recording_->progress(); }
  std::string faults() const override;

 private:
  void read_up_to(core::Time end);

  std::unique_ptr<camera::RecordingReader> recording_;
  camera::RecordingPart part_;
  camera::RecordingPart waiting_;  // read and not yet published
  core::Time begin_{};
  std::uint64_t left_out_ = 0;  // frames and samples
  bool more_ = true;
};

}  // namespace nightjar::scenarios
