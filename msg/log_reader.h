#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "msg/message.h"

namespace nightjar::msg {

/// Reads an LCM log (LogWriter, lcm-logger) message by message.
class LogReader {
 public:
  /// Throws std::invalid_argument, naming the file, when it cannot be read.
  explicit LogReader(std::filesystem::path path);
  ~LogReader();
  LogReader(const LogReader&) = delete;
  LogReader& operator=(const LogReader&) = delete;

  /// The next message; nothing at the end, which for LCM is also a place that is damaged.
  std::optional<Message> next();

  /// Share of the file that has been read, 0 to 1.
  double progress() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether the file begins as LCM logs do.
bool is_log(const std::filesystem::path& path);

}  // namespace nightjar::msg
