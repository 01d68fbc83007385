#pragma once

#include <functional>
#include <optional>
#include <string>

#include "msg/bus.h"
#include "msg/step_receiver.h"
#include "msg/step_sender.h"
#include "scenarios/process_report.h"
#include "scenarios/process_roles.h"

namespace nightjar::scenarios {

/// What joins a source of events to the other processes: the source publishes a packet's
/// messages on the bus inside, this sends them over `wire` and brings the answers back in.
class SourceLink {
 public:
  struct Options {
    bool lock_step = true;
    /// Called every 50 ms or more often while waiting; what it throws ends the wait.
    std::function<void()> while_waiting = [] {};
  };

  /// `answers` come from the process that closes the loop; without them nothing is heard, as
  /// lock-step needs it to be, and a step's latency is that of its sending. `wire` must
  /// outlive it.
  SourceLink(msg::Bus& wire, std::optional<Sending> answers, Options options);

  /// Where the source publishes, kFromSource last the events, and hears the answers.
  msg::Bus& inside() { return inside_; }

  bool lock_step() const { return options_.lock_step; }

  /// Free-running: waits until as much time has passed since the first call as lies between
  /// its `t` and this one, and returns when that was, by steady_now(); a source that is late is
  /// not asked to catch up. In lock-step returns nothing at once.
  std::optional<core::Time> wait_until_due(core::Time t);

  /// Sends what was published inside as the step of time `t`, which the source has had since
  /// `origin`, by steady_now(): just now unless given. In lock-step waits for the answer, and
  /// sends the step again whenever there is none for a tenth of a second.
  void exchange(core::Time t, std::optional<core::Time> origin = std::nullopt);

  /// For a source that has nothing to send, every second or more often: calls while_waiting.
  void idle() { options_.while_waiting(); }

  ProcessMeter& meter() { return meter_; }

 private:
  bool take_answers(std::optional<core::Time> wanted);
  void receive();
  void wait(core::Time at_most);

  msg::Bus& wire_;
  Options options_;
  msg::Bus inside_;
  msg::StepSender sender_;
  std::optional<msg::StepReceiver> receiver_;  ///< Of the answers.
  ProcessMeter meter_;
  std::int64_t run_;
  std::optional<core::Time> zero_;  ///< Steady clock's time of t = 0.
};

}  // namespace nightjar::scenarios
