#pragma once

#include <cstddef>
#include <cstdint>

namespace nightjar::msg {

// LCM's log (eventlog.c): message after message, each a head of 28 bytes, most significant
// byte first (the mark, its number, when it came in us, length of channel and of data), then
// the channel's name and the data.
inline constexpr std::uint32_t kLogMark = 0xeda1da01;
inline constexpr std::size_t kLogHeadBytes = 28;
inline constexpr std::size_t kMostChannelBytes = 999;                    // what LCM reads
inline constexpr std::size_t kMostLogDataBytes = std::size_t{64} << 20;  // ours

}  // namespace nightjar::msg
