#include "msg/lcm_bytes.h"

#include <fmt/format.h>

namespace nightjar::msg {
namespace {

constexpr std::size_t kFingerprintBytes = 8;

/// LCM's numbers have their most significant byte first.
template <class Unsigned>
Unsigned read_big_endian(std::span<const std::uint8_t> bytes, std::size_t offset) {
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
    value = static_cast<Unsigned>(value << 8) | bytes[offset + i];
  return value;
}

}  // namespace

void check_array_fits(const char* type, std::span<const std::uint8_t> bytes,
                      std::size_t count_offset, std::size_t element_bytes) {
  const std::size_t head = count_offset + sizeof(std::uint32_t);
  if (bytes.size() < head)
    throw std::invalid_argument(
        fmt::format("{}: {} bytes, wanted at least {}", type, bytes.size(), head));
  const auto n = static_cast<std::int32_t>(read_big_endian<std::uint32_t>(bytes, count_offset));
  const std::size_t left = bytes.size() - head;
  if (n < 0 || static_cast<std::size_t>(n) * element_bytes != left)
    throw std::invalid_argument(fmt::format("{}: n = {}, but {} bytes follow, wanted {} an element",
                                            type, n, left, element_bytes));
}

core::Time message_time(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kFingerprintBytes + sizeof(std::uint64_t))
    throw std::invalid_argument(
        fmt::format("message: {} bytes, too few to hold a time", bytes.size()));
  return core::Time(
      static_cast<std::int64_t>(read_big_endian<std::uint64_t>(bytes, kFingerprintBytes)));
}

}  // namespace nightjar::msg
