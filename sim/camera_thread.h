#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <vector>

#include "core/event.h"
#include "core/image.h"
#include "sim/simulated_camera.h"
#include "sim/worker.h"

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

  /// The picture to draw next; waits while all of them are still to be exposed.
  core::Image<float>& next();
  /// Exposes the camera to the picture that next() gave, as of time `t`.
  void expose(core::Time t, bool ends_packet);
  /// There will be no more pictures, for this reason: take() throws it, as what the camera
  /// throws itself.
  void fail(std::exception_ptr error);

  /// The earliest packet that was not taken yet; waits until its last picture is
  /// exposed. After the packets that were complete when SimulatedCamera::expose threw or
  /// fail() was called, throws that, every time. Once every packet is taken, and until the next
  /// expose(), the camera itself may be looked at.
  CameraOutput take();

 private:
  struct Picture {
    core::Time t{};
    bool ends_packet = false;
    core::Image<float> luminance_lux;
  };

  void show(const Picture& picture);

  SimulatedCamera& camera_;
  Picture* next_ = nullptr;  ///< The one being drawn.
  std::deque<CameraOutput> outputs_;
  std::exception_ptr error_;
  std::mutex mutex_;  ///< Of outputs_ and error_.
  std::condition_variable changed_;
  // With one picture being exposed, the second waits and the third is drawn.
  Worker<Picture, 3> worker_;  // last: it uses the others
};

}  // namespace nightjar::sim
