#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>

#include "core/part_file.h"
#include "msg/bus.h"
#include "msg/channels.h"

namespace nightjar::msg {

/// Writes messages to an ordinary LCM log (lcm-logplayer, lcm-spy). Each is
/// stamped with its own time, never with the wall clock: equal runs give equal
/// logs. The log has its name only after finish(): see core::PartFile.
class LogWriter {
 public:
  /// Throws where core::PartFile does.
  explicit LogWriter(std::filesystem::path path) : file_(std::move(path)) {}
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Records a channel from now on. The writer must outlive the bus's last
  /// dispatch(); messages after finish() are not recorded.
  template <class T>
  void record(Bus& bus, const Channel<T>& channel) {
    bus.subscribe_bytes(channel.name,
                        [this, name = std::string(channel.name)](
                            std::span<const std::uint8_t> bytes) { write(name, bytes); });
  }

  /// Appends one message. Throws std::invalid_argument for one that LCM would not read
  /// (a channel of no or of over 999 bytes, no time, over 64 MiB), std::runtime_error when
  /// the disk does not take it.
  void write(const std::string& channel, std::span<const std::uint8_t> bytes);

  /// Gives the log its own name. Throws std::runtime_error when not everything
  /// reached the disk.
  void finish();

 private:
  core::PartFile file_;
  std::uint64_t messages_ = 0;
  bool finished_ = false;
};

}  // namespace nightjar::msg
