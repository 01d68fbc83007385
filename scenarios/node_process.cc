#include "scenarios/node_process.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace nightjar::scenarios {
namespace {

// A process further behind than this, 50 ms at 100 steps a second, leaves steps out.
constexpr std::size_t kMostBehind = 5;

}  // namespace

NodeProcess::NodeProcess(msg::Bus& wire, Setup setup)
    : wire_(wire),
      setup_(std::move(setup)),
      meter_(setup_.output.sender),
      sender_(wire, setup_.output.sender),
      held_(setup_.inputs.size()) {
  for (const Sending& input : setup_.inputs)
    receivers_.emplace_back(wire, input.sender, input.channels);
  make_node();
}

void NodeProcess::serve(std::chrono::milliseconds at_most) {
  if (wire_.wait(at_most)) receive();
  // The others' steps, vehicle states, cost next to nothing and are missed when left out.
  meter_.total().steps_dropped += receivers_.back().drop_all_but(kMostBehind);
  for (std::size_t input = 0; input < receivers_.size(); ++input)
    while (auto step = receivers_[input].next()) take(input, std::move(*step));
  count_losses();
}

void NodeProcess::refuse(const std::string& why) {
  if (meter_.total().refused++ == 0) meter_.total().first_refusal = why;
}

/// Anyone may send on the wire: what does not decode must not end a flight.
void NodeProcess::receive() {
  for (bool done = false; !done;) try {
      wire_.dispatch();
      done = true;
    } catch (const std::invalid_argument& error) {
      refuse(error.what());
    }
}

void NodeProcess::make_node() {
  node_.reset();
  inside_ = std::make_unique<msg::Bus>();
  node_ = setup_.make_node(*inside_);
  for (const std::string& channel : setup_.output.channels)
    inside_->subscribe_bytes(channel, [this, channel](std::span<const std::uint8_t> bytes) {
      sender_.add(channel, bytes);
    });
}

void NodeProcess::begin_run(std::int64_t run) {
  if (run_) make_node();  // the first is there, so that no packet waits for it
  held_.assign(held_.size(), std::nullopt);
  answered_.reset();
  run_ = run;
}

void NodeProcess::take(std::size_t input, msg::ReceivedStep step) {
  if (input == 0 && step.mark.run != run_) begin_run(step.mark.run);
  if (step.mark.run != run_) return;  // of a run that is over or that we do not know yet
  if (step.mark.lock_step) return take_in_lock_step(input, std::move(step));
  hand_over(step);
  if (input + 1 == receivers_.size()) answer(step.mark);
}

void NodeProcess::take_in_lock_step(std::size_t input, msg::ReceivedStep step) {
  const core::Time t = step.mark.t;
  const bool asks_for_an_answer = input + 1 == receivers_.size();
  if (answered_ && t <= *answered_) {  // the answer was lost
    if (asks_for_an_answer && t == *answered_) {
      sender_.repeat();
      ++meter_.total().steps_repeated;
    }
    return;
  }
  held_[input] = std::move(step);
  const auto is_there = [t](const auto& held) { return held && held->mark.t == t; };
  if (!std::ranges::all_of(held_, is_there)) return;
  for (const auto& held : held_) hand_over(*held);
  answer(held_.back()->mark);
}

void NodeProcess::hand_over(const msg::ReceivedStep& step) {
  for (const msg::Message& message : step.messages)
    inside_->publish_bytes(message.channel, message.bytes);
  for (bool done = false; !done;) try {
      inside_->dispatch();
      done = true;
    } catch (const std::invalid_argument& error) {
      refuse(error.what());
    }
}

void NodeProcess::answer(const msg::StepMark& mark) {
  sender_.send(mark);
  answered_ = mark.t;
  meter_.count_step();
  meter_.add_latency(steady_now() - mark.origin);
}

void NodeProcess::count_losses() {
  ProcessReport& total = meter_.total();
  total.messages_lost = total.steps_lost = 0;
  for (const msg::StepReceiver& receiver : receivers_) {
    total.messages_lost += receiver.counts().messages_lost;
    total.steps_lost += receiver.counts().steps_lost;
  }
}

}  // namespace nightjar::scenarios
