#include "msg/step_sender.h"

#include <algorithm>
#include <utility>

#include "msg/event_parts.h"

namespace nightjar::msg {
namespace {

std::vector<StepMark::Sent> counted(const std::vector<Message>& messages) {
  std::vector<StepMark::Sent> sent;
  for (const Message& message : messages) {
    const auto entry = std::ranges::find(sent, message.channel, &StepMark::Sent::channel);
    if (entry == sent.end())
      sent.push_back({message.channel, 1});
    else
      ++entry->messages;
  }
  return sent;
}

}  // namespace

void StepSender::add(const std::string& channel, std::span<const std::uint8_t> bytes) {
  next_.push_back({channel, Bytes(bytes.begin(), bytes.end())});
}

void StepSender::send(StepMark mark) {
  if (mark.run != mark_.run) sequence_ = 0;
  last_.clear();
  for (Message& message : std::exchange(next_, {})) {
    if (message.channel != kEvents.name) {
      last_.push_back(std::move(message));
      continue;
    }
    for (Bytes& part : cut_events(message.bytes, sequence_))
      last_.push_back({kEventParts, std::move(part)});
  }
  mark_ = std::move(mark);
  mark_.sender = sender_;
  mark_.sequence = sequence_++;
  mark_.sent = counted(last_);
  publish();
}

void StepSender::repeat() {
  if (sequence_ > 0) publish();
}

void StepSender::publish() {
  for (const Message& message : last_) wire_.publish_bytes(message.channel, message.bytes);
  wire_.publish(kStep, mark_);
}

}  // namespace nightjar::msg
