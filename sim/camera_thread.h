#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "sim/simulated_camera.h"

namespace nightjar::sim {

/// What a camera hands over at the end of a packet.
struct CameraOutput {
  core::EventPacket packet;
  std::vector<core::ApsFrame> frames;  ///< Those completed since the packet before.
};

/// Exposes a camera on a thread of its own, so that the next picture is drawn
/// meanwhile. The camera sees the same pictures in the same order as without it, so
/// nothing of what it gives depends on timing. One thread draws, one takes.
class CameraThread {
 public:
  explicit CameraThread(SimulatedCamera& camera);
  ~CameraThread();
  CameraThread(const CameraThread&) = delete;
  CameraThread& operator=(const CameraThread&) = delete;

  /// The picture to draw next; waits while all of them are still to be exposed.
  core::Image<float>& next();
  /// Exposes the camera to the picture that next() gave, as of time `t`.
  void expose(core::Time t, bool ends_packet);

  /// The earliest packet that was not taken yet; waits until its last picture is
  /// exposed. After the packets that were complete when SimulatedCamera::expose threw,
  /// throws that, every time. Once every packet is taken, and until the next expose(),
  /// the camera itself may be looked at.
  CameraOutput take();

 private:
  struct Picture {
    core::Time t{};
    bool ends_packet = false;
    core::Image<float> luminance_lux;
  };

  void run();

  // With one picture being exposed, the second waits and the third is drawn.
  static constexpr std::size_t kPictures = 3;

  SimulatedCamera& camera_;
  std::array<Picture, kPictures> pictures_;
  std::size_t drawn_ = 0;    ///< Pictures handed over so far.
  std::size_t exposed_ = 0;  ///< Of those, exposed.
  std::deque<CameraOutput> outputs_;
  bool stopping_ = false;
  std::exception_ptr error_;
  std::mutex mutex_;  ///< Of all from drawn_ on.
  std::condition_variable changed_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace nightjar::sim
