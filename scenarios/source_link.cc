#include "scenarios/source_link.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

constexpr core::Time kRepeatAfter = 100ms;
constexpr core::Time kLongestWait = 50ms;
// A source later than this has not kept real time: half of what is usual between steps.
constexpr core::Time kLate = 5ms;

/// Runs begin at different times, also on different computers.
std::int64_t new_run() {
  return std::chrono::system_clock::now().time_since_epoch() / std::chrono::microseconds(1);
}

}  // namespace

SourceLink::SourceLink(msg::Bus& wire, std::optional<Sending> answers, Options options)
    : wire_(wire),
      options_(std::move(options)),
      sender_(wire, kFromSource.sender),
      meter_(kFromSource.sender),
      run_(new_run()) {
  assert(answers || !options_.lock_step);
  if (answers) receiver_.emplace(wire, answers->sender, answers->channels);
  for (const std::string& channel : kFromSource.channels)
    inside_.subscribe_bytes(channel, [this, channel](std::span<const std::uint8_t> bytes) {
      sender_.add(channel, bytes);
    });
}

/// Anyone may send on the wire: what does not decode must not end a flight.
void SourceLink::receive() {
  for (msg::Bus* bus : {&wire_, &inside_})
    for (bool done = false; !done;) try {
        bus->dispatch();
        done = true;
      } catch (const std::invalid_argument& error) {
        if (meter_.total().refused++ == 0) meter_.total().first_refusal = error.what();
      }
}

/// Whether the answer to the step of time `wanted` was among them.
bool SourceLink::take_answers(std::optional<core::Time> wanted) {
  if (!receiver_) return false;
  bool came = false;
  receive();
  while (const auto step = receiver_->next()) {
    const msg::StepMark& mark = step->mark;
    if (mark.run != run_ || (options_.lock_step && (came || mark.t != wanted))) continue;
    for (const msg::Message& message : step->messages)
      inside_.publish_bytes(message.channel, message.bytes);
    came |= mark.t == wanted;
    meter_.add_latency(steady_now() - mark.origin);
  }
  receive();
  meter_.total().messages_lost = receiver_->counts().messages_lost;
  meter_.total().steps_lost = receiver_->counts().steps_lost;
  return came;
}

void SourceLink::wait(core::Time at_most) {
  options_.while_waiting();
  wire_.wait(std::chrono::ceil<std::chrono::milliseconds>(std::min(at_most, kLongestWait)));
}

std::optional<core::Time> SourceLink::wait_until_due(core::Time t) {
  if (options_.lock_step) return std::nullopt;
  if (!zero_) zero_ = steady_now() - t;
  const core::Time late = steady_now() - (*zero_ + t);
  if (late > kLate) {
    ++meter_.total().steps_late;
    *zero_ += late;
  }
  take_answers(std::nullopt);
  for (core::Time now = steady_now(); now < *zero_ + t; now = steady_now()) {
    wait(*zero_ + t - now);
    take_answers(std::nullopt);
  }
  return steady_now();
}

void SourceLink::exchange(core::Time t, std::optional<core::Time> origin) {
  inside_.dispatch();
  msg::StepMark mark;
  mark.t = t;
  mark.run = run_;
  mark.lock_step = options_.lock_step;
  mark.origin = origin.value_or(steady_now());
  sender_.send(mark);
  meter_.count_step();
  if (!receiver_) meter_.add_latency(steady_now() - mark.origin);
  options_.while_waiting();
  if (!options_.lock_step) return;
  core::Time repeat_at = steady_now() + kRepeatAfter;
  while (!take_answers(t)) {
    wait(repeat_at - steady_now());
    if (steady_now() < repeat_at) continue;
    sender_.repeat();
    ++meter_.total().steps_repeated;
    repeat_at = steady_now() + kRepeatAfter;
  }
}

}  // namespace nightjar::scenarios
