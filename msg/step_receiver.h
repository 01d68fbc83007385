#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "msg/bus.h"
#include "msg/message.h"
#include "msg/step_mark.h"

namespace nightjar::msg {

/// What a process got of a sender's step: its messages in the order they were sent, and
/// last the event packets, put together.
struct ReceivedStep {
  StepMark mark;
  std::vector<Message> messages;
};

/// So far.
struct ReceiverCounts {
  std::uint64_t steps = 0;          ///< Handed out by next(), repeats too.
  std::uint64_t messages_lost = 0;  ///< That marks counted and that did not come.
  std::uint64_t steps_lost = 0;     ///< Whose mark did not come.
};

/// Gathers one sender's steps. In lock-step a step of which something is missing is thrown
/// away, since it will come again; else what did come is handed out and the rest counted.
class StepReceiver {
 public:
  /// Listens for the rest of the bus's life, which must outlive it; `channels` are those to
  /// take messages of, and no one else sends on them what does not belong to the step.
  StepReceiver(Bus& wire, std::string sender, std::vector<std::string> channels);
  StepReceiver(const StepReceiver&) = delete;
  StepReceiver& operator=(const StepReceiver&) = delete;

  /// The oldest step not handed out yet.
  std::optional<ReceivedStep> next();

  /// Leaves out all but the latest `keep` of those, save in lock-step; returns how many.
  std::size_t drop_all_but(std::size_t keep);

  const ReceiverCounts& counts() const { return counts_; }

 private:
  void take(const std::string& channel, std::span<const std::uint8_t> bytes);
  void close(const StepMark& mark);
  std::uint64_t missing(const StepMark& mark) const;
  bool same_number_of_each(const StepMark& mark) const;
  std::int64_t arrived(const std::string& channel) const;
  void count_gap(const StepMark& mark);

  std::string sender_;
  std::vector<std::string> channels_;
  std::vector<Message> arrived_;
  std::optional<StepMark> last_;
  std::deque<ReceivedStep> ready_;
  ReceiverCounts counts_;
};

}  // namespace nightjar::msg
