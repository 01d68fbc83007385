#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "camera/caer_device.h"

namespace nightjar::test {

// Packets as libcaer has them in memory: a header, then the events.
std::string caer_packet(int type, int event_size, int overflow, int number,
                        const std::string& events);
/// A valid event at (x, y).
std::string caer_polarity(std::uint32_t x, std::uint32_t y, bool on, std::int32_t t_us);
std::string caer_special(std::uint32_t type, std::int32_t t_us);
std::string caer_imu6(std::int32_t t_us);
/// Of one row, a pixel a level.
std::string caer_frame(std::int32_t begin_us, std::int32_t end_us,
                       const std::vector<std::uint16_t>& levels);

/// Nothing but polarity events at the times given.
std::string caer_events_at(int overflow, const std::vector<std::int32_t>& times_us);

struct CaerDoubleContainer {
  std::vector<std::string> packets;
  std::uint64_t lost_before = 0;
  std::chrono::microseconds host_time{};  ///< The computer's clock is set to this.
};

/// What happens from one opening of the camera to the next.
struct CaerDoubleSession {
  int failures_before = 0;  ///< Attempts to open that find no camera.
  std::vector<CaerDoubleContainer> containers = {};
  bool unplugged_then = false;  ///< Else it stays, and is silent.
};

/// Stands where libcaer and a camera would. Its read() waits for ever where the camera is
/// silent, unless it is interrupted.
class CaerDouble {
 public:
  explicit CaerDouble(std::vector<CaerDoubleSession> sessions);

  camera::CaerOpener opener();

  /// Returns once a read() waits for a silent camera.
  void wait_for_silence();

  /// The computer's clock.
  std::chrono::steady_clock::time_point now() const;

  camera::CaerDeviceInfo info{"00000123", 5, {346, 260}, true, true};
  /// The call to refuse, none if negative: of module and parameter.
  std::pair<int, int> refused{-128, -1};
  bool silence_times_out = false;  ///< read() gives up at once instead.

  using Address = std::pair<int, int>;
  std::map<Address, std::uint32_t> settings;         ///< Those sent last, ...
  std::map<int, std::uint64_t> noise_filter;         ///< ... also to the software filter,
  std::map<Address, std::uint32_t> settings_before;  ///< ... and before the data began.
  int opened = 0;
  std::string serial_asked;

 private:
  class Device;

  std::deque<CaerDoubleSession> sessions_;
  mutable std::mutex mutex_;  ///< Of all that follows.
  std::condition_variable silence_;
  bool silent_ = false;
  std::chrono::microseconds host_time_{};
};

}  // namespace nightjar::test
