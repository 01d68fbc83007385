#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "camera/caer_config.h"
#include "camera/caer_device.h"
#include "camera/event_source.h"
#include "camera/recording_intake.h"

namespace nightjar::camera {

/// A DAVIS346 through libcaer. A camera that goes away is looked for again, with pauses
/// that double, until it is back or stop() is called.
class CaerCamera : public EventSource {
 public:
  using HostClock = std::function<std::chrono::steady_clock::time_point()>;

  static constexpr core::Resolution kSize{346, 260};

  /// Throws std::invalid_argument for a `config` out of range. `open` and `now` are for
  /// tests.
  explicit CaerCamera(const CaerConfig& config, CaerOpener open = open_caer_device,
                      HostClock now = std::chrono::steady_clock::now);
  ~CaerCamera() override;
  CaerCamera(const CaerCamera&) = delete;
  CaerCamera& operator=(const CaerCamera&) = delete;

  std::string name() const override;
  core::Resolution size() const override { return kSize; }
  void start() override;
  Arrival next(LivePacket& packet) override;
  void stop() override;
  SourceCounts counts() const override;

 private:
  using HostTime = std::chrono::steady_clock::time_point;

  void open();
  void close();
  Arrival look_for_camera();
  Arrival lose_camera();
  bool take(LivePacket& packet);
  void place_in_time(LivePacket& packet);
  void count(const LivePacket& packet, std::uint64_t packets_lost);

  const CaerConfig config_;
  const CaerOpener open_camera_;
  const HostClock now_;

  // Of the thread that reads. What it keeps of a camera begins anew with every opening.
  CaerContainer container_;
  RecordingIntake intake_{kSize};
  RecordingFaults earlier_faults_;  ///< Of the openings before.
  std::uint64_t containers_ = 0;    ///< Since the opening.
  core::Time end_{};                ///< Of the latest packet, on the source's time line.
  HostTime end_received_;           ///< When that came.
  core::Time shift_{};              ///< From the camera's time since the opening to ours.
  bool shift_known_ = true;
  bool any_packet_ = false;
  bool gap_ = false;  ///< Before the next packet.
  std::chrono::microseconds pause_{};
  HostTime next_attempt_;

  mutable std::mutex mutex_;  ///< Of all that follows.
  std::condition_variable stopped_;
  std::atomic<bool> stopping_ = false;
  std::unique_ptr<CaerDevice> device_;  ///< Changed by the reading thread only.
  std::string serial_;
  SourceCounts counts_;
};

}  // namespace nightjar::camera
