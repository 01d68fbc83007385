#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msg/bus.h"
#include "msg/step_receiver.h"
#include "msg/step_sender.h"
#include "scenarios/process_report.h"
#include "scenarios/process_roles.h"

namespace nightjar::scenarios {

/// A node of the loop as a process of its own: it hands the node what others send over
/// `wire`, on a bus inside this process, and sends what the node answers. Whether steps are
/// repeated until all is there (lock-step) or dealt with as they come is up to the source.
class NodeProcess {
 public:
  struct Setup {
    /// Of them the source comes first, and the last is what the node answers to.
    std::vector<Sending> inputs;
    Sending output;
    /// Makes the node on a bus; called anew for each run of a source, the first time at once.
    std::function<std::shared_ptr<void>(msg::Bus&)> make_node;
  };

  /// `wire` must outlive it. Throws what `setup.make_node` does.
  NodeProcess(msg::Bus& wire, Setup setup);

  /// Waits `at_most` so long for messages and deals with all there are. Messages that
  /// cannot be used are counted; whatever else a node throws comes out here.
  void serve(std::chrono::milliseconds at_most);

  ProcessMeter& meter() { return meter_; }

 private:
  void receive();
  void take(std::size_t input, msg::ReceivedStep step);
  void take_in_lock_step(std::size_t input, msg::ReceivedStep step);
  void make_node();
  void begin_run(std::int64_t run);
  void hand_over(const msg::ReceivedStep& step);
  void answer(const msg::StepMark& mark);
  void count_losses();
  void refuse(const std::string& why);

  msg::Bus& wire_;
  Setup setup_;
  ProcessMeter meter_;
  msg::StepSender sender_;
  std::deque<msg::StepReceiver> receivers_;             // one an input
  std::vector<std::optional<msg::ReceivedStep>> held_;  // likewise, in lock-step
  std::unique_ptr<msg::Bus> inside_;
  std::shared_ptr<void> node_;  // after the bus it uses
  std::optional<std::int64_t> run_;
  std::optional<core::Time> answered_;
};

}  // namespace nightjar::scenarios
