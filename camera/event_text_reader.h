#pragma once

#include <memory>
#include <optional>
#include <string>

#include "camera/event_text_lines.h"
#include "camera/recording.h"
#include "camera/recording_intake.h"

namespace nightjar::camera {

/// The text of RPG and v2e, ten thousand events a part. A last line that is cut off is a
/// truncated file's; any other line that is no event throws.
class EventTextReader : public RecordingReader {
 public:
  /// `in` at its beginning. Throws as open_recording() does, with the line.
  EventTextReader(std::unique_ptr<std::istream> in, std::string name,
                  std::optional<core::Resolution> size);

  std::string format() const override { return "text"; }
  std::string camera() const override { return {}; }
  core::Resolution size() const override { return intake_.size(); }
  bool next(RecordingPart& part) override;
  double progress() const override;
  const RecordingFaults& faults() const override { return intake_.faults(); }

 private:
  void end();

  std::unique_ptr<std::istream> in_;
  std::uint64_t length_ = 0;
  RecordingIntake intake_;
  EventTextLines lines_;
  bool ended_ = false;
};

}  // namespace nightjar::camera
