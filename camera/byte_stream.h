#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace nightjar::camera {

static_assert(std::endian::native == std::endian::little);

/// The number at `at` of `bytes`, least significant byte first. The caller has checked
/// that it is there.
template <class T>
T little_endian(std::span<const std::byte> bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.subspan(at, sizeof(T)).data(), sizeof(T));
  return value;
}

/// As above, most significant byte first.
inline std::uint32_t big_endian_u32(std::span<const std::byte> bytes, std::size_t at) {
  return __builtin_bswap32(little_endian<std::uint32_t>(bytes, at));
}

/// A file read forwards that knows where it is, so that errors can name the byte and no
/// declared size is believed beyond the file's end.
class ByteStream {
 public:
  /// Throws std::invalid_argument when `in` cannot seek.
  ByteStream(std::unique_ptr<std::istream> in, std::string name);

  const std::string& name() const { return name_; }
  std::uint64_t offset() const { return offset_; }  ///< Of the next byte.
  std::uint64_t left() const { return length_ - offset_; }
  double progress() const;

  /// The next `count` bytes; the caller has checked that they are left.
  void read(std::size_t count, std::vector<std::byte>& bytes);

  /// The next line, without its LF or CRLF. Throws std::invalid_argument for one of more
  /// than `most` bytes and when none is left.
  std::string read_line(std::size_t most);

  /// The next byte, which stays where it is; -1 at the end.
  int peek();

  void skip_to(std::uint64_t offset);

  /// "FILE: byte N: why".
  std::string at(std::uint64_t offset, const std::string& why) const;

 private:
  std::unique_ptr<std::istream> in_;
  std::string name_;
  std::uint64_t offset_ = 0;
  std::uint64_t length_ = 0;
};

}  // namespace nightjar::camera
