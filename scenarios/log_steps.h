#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "camera/recording.h"
#include "msg/log_reader.h"
#include "scenarios/recording_info.h"
#include "scenarios/repeat_filter.h"
#include "scenarios/step_reader.h"

namespace nightjar::scenarios {

/// What a source sent, out of an LCM log: of kFromSource's channels only, for the other
/// processes will say the rest anew. Events that do not decode are passed over and counted as
/// damaged, and so is what comes before events by more than ten thousand messages.
class LogSteps : public StepReader {
 public:
  /// Throws std::invalid_argument, naming the file, when it cannot be read or holds no
  /// events.
  explicit LogSteps(const std::filesystem::path& path);

  std::optional<core::Time> next(msg::Bus& bus) override;
  bool has_vehicle_states() const override;
  double progress() const override { return log_.progress(); }
  std::string faults() const override { return fault_text(faults_); }

 private:
  bool read_step();
  bool take(msg::Message message);
  void take_part(msg::Bytes part);
  bool close_with(std::vector<msg::Bytes> packets);
  bool decodes(const msg::Bytes& packet);
  template <class T>
  void make_room(std::vector<T>& waiting);
  void count_lost();
  void count(std::uint64_t camera::RecordingFaults::*what, std::uint64_t amount,
             const std::string& why);

  msg::LogReader log_;
  RepeatFilter repeats_;
  std::vector<msg::Message> step_;  // read ahead; empty at the end
  std::vector<msg::Bytes> parts_;
  camera::RecordingFaults faults_;
};

}  // namespace nightjar::scenarios
