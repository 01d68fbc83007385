#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "msg/lcm_bytes.h"

// For event_packet_t and event_part_t, which end with a count and so many words of eight
// bytes; for the sources of this folder. lcm-gen's code takes words one by one through a
// vector, which at millions of events a second is much of a loop's latency: here only the
// head passes through it.
namespace nightjar::msg {

inline constexpr std::size_t kWordBytes = 8;

/// `head`, a message without words, as it is encoded with `n` of them: their room is there.
template <class Lcm>
Bytes with_room_for_words(const Lcm& head, std::size_t n) {
  Bytes bytes = to_bytes(head);
  for (std::size_t i = 1; i <= sizeof(std::uint32_t); ++i)
    bytes[bytes.size() - i] = static_cast<std::uint8_t>(n >> 8 * (i - 1));
  bytes.resize(bytes.size() + n * kWordBytes);
  return bytes;
}

/// The message but for its words, whose 32-bit count lies at `count_offset`. Throws
/// std::invalid_argument as check_array_fits() and from_bytes() do.
template <class Lcm>
Lcm read_head(std::span<const std::uint8_t> bytes, std::size_t count_offset) {
  check_array_fits(Lcm::getTypeName(), bytes, count_offset, kWordBytes);
  Bytes head(count_offset + sizeof(std::uint32_t));  // which counts no words
  std::copy_n(bytes.begin(), count_offset, head.begin());
  return from_bytes<Lcm>(head);
}

/// The words of a message that read_head() took.
inline std::span<const std::uint8_t> words_of(std::span<const std::uint8_t> bytes,
                                              std::size_t count_offset) {
  return bytes.subspan(count_offset + sizeof(std::uint32_t));
}

inline void put_word(std::uint64_t word, std::uint8_t* to) {
  for (std::size_t i = 0; i < kWordBytes; ++i)
    to[i] = static_cast<std::uint8_t>(word >> 8 * (kWordBytes - 1 - i));
}

inline std::uint64_t get_word(const std::uint8_t* from) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < kWordBytes; ++i) word = word << 8 | from[i];
  return word;
}

}  // namespace nightjar::msg
