#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "msg/log_format.h"
#include "msg/message.h"

namespace nightjar::msg {

/// Reads an LCM log (LogWriter, lcm-logger) message by message; no message takes more than
/// 64 MiB. What is damaged or cut off is passed over up to the next message that is whole.
class LogReader {
 public:
  /// Throws std::invalid_argument, naming the file, when it cannot be read.
  explicit LogReader(const std::filesystem::path& path);

  /// The same from a stream that can seek; `name` stands for the file in errors.
  LogReader(std::unique_ptr<std::istream> in, std::string name);

  /// The next message; nothing at the end. Throws std::invalid_argument "FILE: byte N: ..."
  /// when the disk fails.
  std::optional<Message> next();

  /// Back to the beginning.
  void rewind() { begin_ = next_ = lost_ = 0; }

  const std::string& name() const { return name_; }

  /// Where the message that next() gave last begins; at the end, the file's length.
  std::uint64_t offset() const { return begin_; }

  /// Bytes passed over so far.
  std::uint64_t bytes_lost() const { return lost_; }

  /// Share of the file that has been read, 0 to 1.
  double progress() const;

 private:
  struct Head {
    std::uint32_t channel_bytes = 0;
    std::uint32_t data_bytes = 0;
  };

  bool find_mark();
  std::optional<Head> read_head();
  std::string_view block_from(std::uint64_t at);
  bool read(std::uint64_t at, std::size_t count, char* to);
  void read_file(std::uint64_t at, std::size_t count, char* to);

  std::unique_ptr<std::istream> in_;
  std::string name_;
  std::uint64_t length_ = 0;
  std::uint64_t begin_ = 0;  ///< Of the message at hand, ...
  std::uint64_t next_ = 0;   ///< ... and of what comes behind it.
  std::uint64_t lost_ = 0;
  std::string block_;              ///< The part of the file that is searched for marks, ...
  std::uint64_t block_begin_ = 0;  ///< ... and where it begins.
};

/// Whether the file begins as LCM logs do.
bool is_log(const std::filesystem::path& path);

}  // namespace nightjar::msg
