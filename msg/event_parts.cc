#include "msg/event_parts.h"

#include <algorithm>
#include <nightjar_lcm/event_packet_t.hpp>
#include <nightjar_lcm/event_part_t.hpp>

#include "msg/event_words.h"

namespace nightjar::msg {
namespace {

constexpr std::size_t kPacketCount = 8 + 8 + 8;        // fingerprint, time_us, begin_us
constexpr std::size_t kPartCount = 8 + 3 * 8 + 2 * 4;  // and sequence, part, parts

using Words = std::span<const std::uint8_t>;

Bytes packet_of(const nightjar_lcm::event_part_t& first, std::span<const Words> parts) {
  std::size_t size = 0;
  for (const Words& words : parts) size += words.size();
  nightjar_lcm::event_packet_t head;
  head.time_us = first.time_us;
  head.begin_us = first.begin_us;
  head.n = 0;
  Bytes packet = with_room_for_words(head, size / kWordBytes);
  auto to = packet.end() - static_cast<std::ptrdiff_t>(size);
  for (const Words& words : parts) to = std::ranges::copy(words, to).out;
  return packet;
}

}  // namespace

std::vector<Bytes> cut_events(std::span<const std::uint8_t> packet, std::int64_t sequence,
                              std::size_t most_events) {
  const auto whole = read_head<nightjar_lcm::event_packet_t>(packet, kPacketCount);
  const Words words = words_of(packet, kPacketCount);
  const std::size_t events = words.size() / kWordBytes;
  nightjar_lcm::event_part_t head;
  head.time_us = whole.time_us;
  head.begin_us = whole.begin_us;
  head.sequence = sequence;
  head.parts =
      static_cast<std::int32_t>(std::max<std::size_t>(1, (events + most_events - 1) / most_events));
  head.n = 0;
  std::vector<Bytes> pieces;
  for (head.part = 0; head.part < head.parts; ++head.part) {
    const std::size_t first = static_cast<std::size_t>(head.part) * most_events;
    const std::size_t count = std::min(most_events, events - first);
    Bytes& piece = pieces.emplace_back(with_room_for_words(head, count));
    const Words cut = words.subspan(first * kWordBytes, count * kWordBytes);
    std::ranges::copy(cut, piece.end() - static_cast<std::ptrdiff_t>(cut.size()));
  }
  return pieces;
}

std::vector<Bytes> join_events(std::span<const Bytes> parts) {
  std::vector<Bytes> packets;
  nightjar_lcm::event_part_t first;
  std::vector<Words> words;  // of the packet at hand
  for (const Bytes& bytes : parts) {
    const auto part = read_head<nightjar_lcm::event_part_t>(bytes, kPartCount);
    if (!words.empty() && part.sequence != first.sequence) {
      packets.push_back(packet_of(first, words));
      words.clear();
    }
    if (words.empty()) first = part;
    words.push_back(words_of(bytes, kPartCount));
  }
  if (!words.empty()) packets.push_back(packet_of(first, words));
  return packets;
}

}  // namespace nightjar::msg
