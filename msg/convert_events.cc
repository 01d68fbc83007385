#include <fmt/format.h>

#include <nightjar_lcm/event_packet_t.hpp>

#include "msg/convert.h"
#include "msg/event_words.h"
#include "msg/lcm_bytes.h"

namespace nightjar::msg {
namespace {

constexpr std::uint64_t kLongestPacket_us = 0x7fffffff;  // what 31 bits can hold

// Where each part begins in a word of event_packet_t.
constexpr int kTimeShift = 33;
constexpr int kOnShift = 32;
constexpr int kYShift = 16;

constexpr std::size_t kCountOffset = 8 + 8 + 8;  // fingerprint, time_us, begin_us

std::uint64_t pack(const core::Event& event, core::Time begin) {
  const auto since_begin_us = static_cast<std::uint64_t>((event.t - begin).count());
  return since_begin_us << kTimeShift | std::uint64_t{event.on} << kOnShift |
         std::uint64_t{event.y} << kYShift | event.x;
}

/// Throws for an event behind the packet's end, whose time may be none that 64 bits hold.
core::Event unpack(std::uint64_t bits, core::Time begin, core::Time length) {
  const core::Time since_begin(static_cast<std::int64_t>(bits >> kTimeShift));
  if (since_begin > length)
    throw std::invalid_argument(
        fmt::format("event packet: event {} us after its beginning, allowed 0 to {} us",
                    since_begin.count(), length.count()));
  return {.t = begin + since_begin,
          .x = static_cast<std::uint16_t>(bits),
          .y = static_cast<std::uint16_t>(bits >> kYShift),
          .on = (bits >> kOnShift & 1) != 0};
}

void check_interval(std::int64_t begin_us, std::int64_t end_us) {
  // Unsigned, because times far apart would overflow a signed difference.
  const auto length_us = static_cast<std::uint64_t>(end_us) - static_cast<std::uint64_t>(begin_us);
  if (end_us < begin_us || length_us > kLongestPacket_us)
    throw std::invalid_argument(fmt::format("event packet: ({}, {}] us, allowed 0 to {} us long",
                                            begin_us, end_us, kLongestPacket_us));
}

void check_events(const core::EventPacket& packet) {
  core::Time last = packet.begin;
  for (const core::Event& event : packet.events) {
    if (event.t <= packet.begin || event.t > packet.end || event.t < last)
      throw std::invalid_argument(fmt::format(
          "event packet: event at {} us after one at {} us, allowed in order and in ({}, {}] us",
          event.t.count(), last.count(), packet.begin.count(), packet.end.count()));
    last = event.t;
  }
}

}  // namespace

Bytes encode(const core::EventPacket& packet) {
  check_interval(to_us(packet.begin), to_us(packet.end));
  check_events(packet);
  nightjar_lcm::event_packet_t message;
  message.time_us = to_us(packet.end);
  message.begin_us = to_us(packet.begin);
  message.n = 0;
  Bytes bytes = with_room_for_words(message, packet.events.size());
  std::uint8_t* word = bytes.data() + bytes.size() - packet.events.size() * kWordBytes;
  for (const core::Event& event : packet.events) {
    put_word(pack(event, packet.begin), word);
    word += kWordBytes;
  }
  return bytes;
}

template <>
core::EventPacket decode(std::span<const std::uint8_t> bytes) {
  const auto message = read_head<nightjar_lcm::event_packet_t>(bytes, kCountOffset);
  check_interval(message.begin_us, message.time_us);
  core::EventPacket packet{core::Time(message.begin_us), core::Time(message.time_us), {}};
  const core::Time length = packet.end - packet.begin;
  const std::span<const std::uint8_t> words = words_of(bytes, kCountOffset);
  packet.events.reserve(words.size() / kWordBytes);
  for (std::size_t i = 0; i < words.size(); i += kWordBytes)
    packet.events.push_back(unpack(get_word(&words[i]), packet.begin, length));
  check_events(packet);
  return packet;
}

}  // namespace nightjar::msg
