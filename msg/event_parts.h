#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "msg/convert.h"

namespace nightjar::msg {

/// So that a piece with its head is one datagram: LCM cuts what is longer than 65,499
/// bytes into fragments, and one lost fragment loses them all.
inline constexpr std::size_t kMostEventsInAPart = 8000;

/// Cuts an encoded core::EventPacket into encoded pieces (msg/event_part_t.lcm), at least
/// one. Throws std::invalid_argument when `packet` is none.
std::vector<Bytes> cut_events(std::span<const std::uint8_t> packet, std::int64_t sequence,
                              std::size_t most_events = kMostEventsInAPart);

/// Puts pieces that came in the order they were sent back together, as encoded packets in
/// the order of their sequence; a packet that lacks pieces has the events of the others.
/// Throws std::invalid_argument for what is no piece.
std::vector<Bytes> join_events(std::span<const Bytes> parts);

}  // namespace nightjar::msg
