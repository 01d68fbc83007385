#include "msg/event_parts.h"

#include <algorithm>
#include <iterator>
#include <nightjar_lcm/event_packet_t.hpp>
#include <nightjar_lcm/event_part_t.hpp>

#include "msg/lcm_bytes.h"

namespace nightjar::msg {
namespace {

nightjar_lcm::event_packet_t read_packet(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kCountOffset = 8 + 8 + 8;  // fingerprint, time_us, begin_us
  check_array_fits("event_packet_t", bytes, kCountOffset, sizeof(std::int64_t));
  return from_bytes<nightjar_lcm::event_packet_t>(bytes);
}

nightjar_lcm::event_part_t read_part(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kCountOffset = 8 + 3 * 8 + 2 * 4;  // and sequence, part, parts
  check_array_fits("event_part_t", bytes, kCountOffset, sizeof(std::int64_t));
  return from_bytes<nightjar_lcm::event_part_t>(bytes);
}

}  // namespace

std::vector<Bytes> cut_events(std::span<const std::uint8_t> packet, std::int64_t sequence,
                              std::size_t most_events) {
  const nightjar_lcm::event_packet_t whole = read_packet(packet);
  const std::size_t parts =
      std::max<std::size_t>(1, (whole.event.size() + most_events - 1) / most_events);
  std::vector<Bytes> pieces;
  nightjar_lcm::event_part_t part;
  part.time_us = whole.time_us;
  part.begin_us = whole.begin_us;
  part.sequence = sequence;
  part.parts = static_cast<std::int32_t>(parts);
  for (std::size_t i = 0; i < parts; ++i) {
    const std::size_t first = i * most_events;
    const std::size_t last = std::min(first + most_events, whole.event.size());
    part.part = static_cast<std::int32_t>(i);
    part.event.assign(whole.event.begin() + static_cast<std::ptrdiff_t>(first),
                      whole.event.begin() + static_cast<std::ptrdiff_t>(last));
    part.n = static_cast<std::int32_t>(part.event.size());
    pieces.push_back(to_bytes(part));
  }
  return pieces;
}

std::vector<Bytes> join_events(std::span<const Bytes> parts) {
  std::vector<Bytes> packets;
  nightjar_lcm::event_packet_t packet;
  std::int64_t sequence = 0;
  bool begun = false;
  const auto complete = [&] {
    packet.n = static_cast<std::int32_t>(packet.event.size());
    if (begun) packets.push_back(to_bytes(packet));
  };
  for (const Bytes& bytes : parts) {
    const nightjar_lcm::event_part_t part = read_part(bytes);
    if (!begun || part.sequence != sequence) {
      complete();
      begun = true;
      sequence = part.sequence;
      packet.time_us = part.time_us;
      packet.begin_us = part.begin_us;
      packet.event.clear();
    }
    std::ranges::copy(part.event, std::back_inserter(packet.event));
  }
  complete();
  return packets;
}

}  // namespace nightjar::msg
