#include "msg/step_receiver.h"

#include <algorithm>
#include <utility>

#include "msg/event_parts.h"

namespace nightjar::msg {
namespace {

// Messages of a sender that never closes a step; beyond them the oldest go.
constexpr std::size_t kMostArrived = 10'000;

std::string on_the_wire(const std::string& channel) {
  return channel == kEvents.name ? kEventParts : channel;
}

/// All in the order it came, then the event packets, with which sources close.
std::vector<Message> joined(std::vector<Message> arrived) {
  std::vector<Bytes> parts;
  std::vector<Message> messages;
  for (Message& message : arrived)
    if (message.channel == kEventParts)
      parts.push_back(std::move(message.bytes));
    else
      messages.push_back(std::move(message));
  for (Bytes& packet : join_events(parts)) messages.push_back({kEvents.name, std::move(packet)});
  return messages;
}

}  // namespace

StepReceiver::StepReceiver(Bus& wire, std::string sender, std::vector<std::string> channels)
    : sender_(std::move(sender)) {
  for (const std::string& channel : channels) {
    channels_.push_back(on_the_wire(channel));
    wire.subscribe_bytes(channels_.back(),
                         [this, name = channels_.back()](std::span<const std::uint8_t> bytes) {
                           take(name, bytes);
                         });
  }
  wire.subscribe(kStep, [this](const StepMark& mark) {
    if (mark.sender == sender_) close(mark);
  });
}

std::optional<ReceivedStep> StepReceiver::next() {
  if (ready_.empty()) return std::nullopt;
  ReceivedStep step = std::move(ready_.front());
  ready_.pop_front();
  ++counts_.steps;
  return step;
}

std::size_t StepReceiver::drop_all_but(std::size_t keep) {
  std::size_t dropped = 0;
  for (; ready_.size() > keep && !ready_.front().mark.lock_step; ++dropped) ready_.pop_front();
  return dropped;
}

void StepReceiver::take(const std::string& channel, std::span<const std::uint8_t> bytes) {
  if (arrived_.size() == kMostArrived) {
    arrived_.erase(arrived_.begin());
    ++counts_.messages_lost;
  }
  arrived_.push_back({channel, Bytes(bytes.begin(), bytes.end())});
}

std::int64_t StepReceiver::arrived(const std::string& channel) const {
  return std::ranges::count(arrived_, channel, &Message::channel);
}

std::uint64_t StepReceiver::missing(const StepMark& mark) const {
  std::int64_t missing = 0;
  for (const auto& [channel, messages] : mark.sent)
    if (std::ranges::find(channels_, channel) != channels_.end())
      missing += std::max<std::int64_t>(0, messages - arrived(channel));
  return static_cast<std::uint64_t>(missing);
}

bool StepReceiver::same_number_of_each(const StepMark& mark) const {
  return std::ranges::all_of(channels_, [&](const std::string& channel) {
    const auto sent = std::ranges::find(mark.sent, channel, &StepMark::Sent::channel);
    return arrived(channel) == (sent == mark.sent.end() ? 0 : sent->messages);
  });
}

/// Whoever comes late has not lost what was sent before.
void StepReceiver::count_gap(const StepMark& mark) {
  if (last_ && last_->run == mark.run && mark.sequence > last_->sequence + 1)
    counts_.steps_lost += static_cast<std::uint64_t>(mark.sequence - last_->sequence - 1);
  last_ = mark;
}

void StepReceiver::close(const StepMark& mark) {
  if (last_) counts_.messages_lost += missing(mark);
  const bool whole = same_number_of_each(mark);
  std::vector<Message> messages = std::exchange(arrived_, {});
  count_gap(mark);
  if (whole || !mark.lock_step) ready_.push_back({mark, joined(std::move(messages))});
}

}  // namespace nightjar::msg
