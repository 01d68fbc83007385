#include <fmt/format.h>

#include <nightjar_lcm/step_t.hpp>

#include "msg/convert.h"
#include "msg/lcm_bytes.h"

namespace nightjar::msg {
namespace {

// The count's four bytes follow the fingerprint, four times eight bytes and a flag; an
// element has at least a text's length and final zero, and a number.
constexpr std::size_t kCountOffset = 8 + 4 * 8 + 1;
constexpr std::size_t kLeastElementBytes = 4 + 1 + 4;

// lcm-gen's decoder makes room for as many elements as a message claims to have.
void check_count(std::span<const std::uint8_t> bytes) {
  std::uint32_t n = 0;
  if (bytes.size() >= kCountOffset + sizeof(n))
    for (const std::uint8_t byte : bytes.subspan(kCountOffset, sizeof(n))) n = n << 8 | byte;
  if (n > bytes.size() / kLeastElementBytes)
    throw std::invalid_argument(
        fmt::format("step_t: n = {} in a message of {} bytes", n, bytes.size()));
}

}  // namespace

Bytes encode(const StepMark& mark) {
  nightjar_lcm::step_t message;
  message.time_us = to_us(mark.t);
  message.run = mark.run;
  message.sequence = mark.sequence;
  message.origin_us = to_us(mark.origin);
  message.lock_step = mark.lock_step;
  message.n = static_cast<std::int32_t>(mark.sent.size());
  for (const StepMark::Sent& sent : mark.sent) {
    nightjar_lcm::step_channel_t channel;
    channel.channel = sent.channel;
    channel.messages = sent.messages;
    message.sent.push_back(std::move(channel));
  }
  message.sender = mark.sender;
  return to_bytes(message);
}

template <>
StepMark decode(std::span<const std::uint8_t> bytes) {
  check_count(bytes);
  const auto message = from_bytes<nightjar_lcm::step_t>(bytes);
  StepMark mark;
  mark.t = core::Time(message.time_us);
  mark.run = message.run;
  mark.sequence = message.sequence;
  mark.origin = core::Time(message.origin_us);
  mark.lock_step = message.lock_step != 0;
  for (const nightjar_lcm::step_channel_t& channel : message.sent)
    mark.sent.push_back({channel.channel, channel.messages});
  mark.sender = message.sender;
  return mark;
}

}  // namespace nightjar::msg
