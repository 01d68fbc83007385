#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/stage_timer.h"
#include "sim/camera_thread.h"
#include "sim/renderer.h"
#include "sim/view.h"
#include "sim/worker.h"

namespace nightjar::sim {

/// Draws views on a thread of its own and exposes a camera to them, in the order in which
/// they come; the physics run on meanwhile. What fails is thrown by CameraThread::take().
class DrawingThread {
 public:
  /// Nobody else draws with `renderer` from now on.
  DrawingThread(Renderer& renderer, const Scene& scene, double white_lux, CameraThread& camera);

  /// The view to look at next; waits while all of them are still to be drawn.
  View& next();
  /// Draws what next() gave, of time `t`.
  void draw(core::Time t, bool ends_packet);

  /// To be asked once the last packet is taken.
  std::uint64_t drawn() const { return drawing_.time().calls; }
  std::vector<core::StageTime> stage_times() const;

 private:
  struct Job {
    core::Time t{};
    bool ends_packet = false;
    std::optional<View> view;
  };

  void draw(const Job& job);

  Renderer& renderer_;
  const Scene& scene_;
  double white_lux_;
  CameraThread& camera_;
  core::StageTimer drawing_{"draw", "drawing"};
  core::StageTimer waiting_{"wait for camera", "drawing"};
  core::StageTimer waiting_ahead_{"wait for drawing", "world"};
  bool failed_ = false;
  Job* next_ = nullptr;  ///< The one being looked at.
  // The views of a usual packet.
  Worker<Job, 6> worker_;  // last: it uses the others
};

}  // namespace nightjar::sim
