#pragma once

#include <filesystem>
#include <vector>

#include "msg/log_reader.h"
#include "scenarios/repeat_filter.h"
#include "scenarios/step_reader.h"

namespace nightjar::scenarios {

/// What a source sent, out of an LCM log: of kFromSource's channels only, for the other
/// processes will say the rest anew.
class LogSteps : public StepReader {
 public:
  /// Throws std::invalid_argument, naming the file, when it cannot be read or holds no
  /// events.
  explicit LogSteps(const std::filesystem::path& path);

  std::optional<core::Time> next(msg::Bus& bus) override;
  bool has_vehicle_states() const override;
  double progress() const override { return log_.progress(); }

 private:
  bool read_step();
  bool close_with(std::vector<msg::Bytes> packets);

  msg::LogReader log_;
  RepeatFilter repeats_;
  std::vector<msg::Message> step_;  // read ahead; empty at the end
  std::vector<msg::Bytes> parts_;
};

}  // namespace nightjar::scenarios
