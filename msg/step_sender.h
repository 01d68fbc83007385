#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "msg/bus.h"
#include "msg/message.h"
#include "msg/step_mark.h"

namespace nightjar::msg {

/// Sends what a process has for one event packet: its messages, then the mark that counts
/// them. Event packets go out in pieces (msg/event_parts.h).
class StepSender {
 public:
  /// `wire` must outlive it.
  StepSender(Bus& wire, std::string sender) : wire_(wire), sender_(std::move(sender)) {}

  /// Adds a message to the step to be sent next.
  void add(const std::string& channel, std::span<const std::uint8_t> bytes);

  /// Sends the step; of `mark`, sender, sequence and sent are filled in here. The sequence
  /// begins anew with another run.
  void send(StepMark mark);

  /// Sends the last step once more, if there is one.
  void repeat();

 private:
  void publish();

  Bus& wire_;
  std::string sender_;
  std::vector<Message> next_;
  std::vector<Message> last_;
  StepMark mark_;
  std::int64_t sequence_ = 0;
};

}  // namespace nightjar::msg
