#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "msg/bus.h"
#include "msg/channels.h"

namespace nightjar::msg {

/// Writes messages to an ordinary LCM log (lcm-logplayer, lcm-spy). Each is
/// stamped with its own time, never with the wall clock: equal runs give equal
/// logs. The log is called NAME.part.EXT until finish(); without finish() it
/// is removed, so a log under its own name is complete.
class LogWriter {
 public:
  /// Throws std::runtime_error when the file cannot be created.
  explicit LogWriter(std::filesystem::path path);
  ~LogWriter();
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

  /// Appends one message. Throws std::runtime_error when the disk does not take it.
  void write(const std::string& channel, std::span<const std::uint8_t> bytes);

  /// Gives the log its own name. Throws std::runtime_error when not everything
  /// reached the disk.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nightjar::msg
