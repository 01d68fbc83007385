#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nightjar::camera {

/// How AEDAT4 packs the content of its packets, by its own numbers.
enum class Compression : std::int32_t { none = 0, lz4 = 1, lz4_high = 2, zstd = 3, zstd_high = 4 };

/// No packet may be larger, packed or not: some hundred times what a camera sends in
/// 10 ms, and little enough to refuse a file that unpacks to more than a machine has.
inline constexpr std::size_t kMostPacketBytes = std::size_t{64} << 20;

/// Unpacks one whole LZ4 or ZSTD frame into `out`. Throws std::invalid_argument (without
/// the place) for what is no such frame, ends early or late, or unpacks to more than
/// kMostPacketBytes; memory stays within a small multiple of that.
void decompress(std::span<const std::byte> packed, Compression compression,
                std::vector<std::byte>& out);

/// The reverse; LZ4_HIGH and ZSTD_HIGH try harder.
std::vector<std::byte> compress(std::span<const std::byte> plain, Compression compression);

}  // namespace nightjar::camera
