#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "core/event.h"
#include "msg/convert.h"

// Between the classes that lcm-gen makes and bytes; for the sources of this folder.
namespace nightjar::msg {

inline std::int64_t to_us(core::Time t) { return t.count(); }

template <class Lcm>
Bytes to_bytes(const Lcm& message) {
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  if (message.encode(bytes.data(), 0, static_cast<int>(bytes.size())) !=
      static_cast<int>(bytes.size()))
    throw std::invalid_argument(std::string(Lcm::getTypeName()) +
                                ": does not encode, is there a zero byte in a text?");
  return bytes;
}

template <class Lcm>
Lcm from_bytes(std::span<const std::uint8_t> bytes) {
  const std::string type = Lcm::getTypeName();
  Lcm message;
  int used = -1;
  try {
    used = message.decode(bytes.data(), 0, static_cast<int>(bytes.size()));
  } catch (const std::length_error&) {  // a text of negative length
  }
  if (used != static_cast<int>(bytes.size()))
    throw std::invalid_argument(type + ": " + std::to_string(bytes.size()) +
                                " bytes are not a message of this type");
  return message;
}

/// lcm-gen's decoders make room for as many elements as a message claims to have,
/// before they look whether it has them. Throws std::invalid_argument unless the
/// message ends exactly after the array whose 32-bit count lies at `count_offset`.
void check_array_fits(const char* type, std::span<const std::uint8_t> bytes,
                      std::size_t count_offset, std::size_t element_bytes);

}  // namespace nightjar::msg
