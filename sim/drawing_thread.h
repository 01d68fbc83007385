#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "core/image.h"
#include "core/stage_timer.h"
#include "sim/view.h"

namespace nightjar::sim {

/// Draws views on a thread of its own, in the order in which they come, while whoever brings
/// them does something else. What was drawn is the same whenever it is fetched. Two threads
/// are in this together, no more: the one that calls, and this one.
class DrawingThread {
 public:
  struct Picture {
    core::Time t{};
    core::Image<float> luminance_lux;
  };

  /// Draws the luminance (lux) that is in view.
  using Draw = std::function<void(const View&, core::Image<float>& luminance_lux)>;

  /// `draw` is called on the other thread; views are of `scene`.
  DrawingThread(const Scene& scene, Draw draw);
  /// Finishes the picture that was begun and leaves the others.
  ~DrawingThread();

  DrawingThread(const DrawingThread&) = delete;
  DrawingThread& operator=(const DrawingThread&) = delete;

  /// A view to look with: one that was drawn, or a new one.
  View blank_view();
  /// To be drawn after those before.
  void add(core::Time t, View view);

  /// The earliest picture that was not taken yet; waits until it is drawn. There must be one.
  /// If drawing it failed, throws why, and so for every later one.
  Picture take();
  /// Its pixels are drawn over.
  void give_back(Picture picture);

  /// To be asked once every picture is taken.
  std::uint64_t drawn() const { return drawing_.time().calls; }
  std::vector<core::StageTime> stage_times() const;

 private:
  struct Job {
    core::Time t{};
    View view;
  };

  void run();

  const Scene& scene_;
  const Draw draw_;
  core::StageTimer drawing_{"draw", "drawing"};
  core::StageTimer waiting_for_views_{"wait for views", "drawing"};
  core::StageTimer waiting_for_pictures_{"wait for drawing", "loop"};

  std::mutex mutex_;  ///< Of all that follows but the thread.
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  std::deque<Picture> pictures_;
  std::vector<View> used_views_;
  std::vector<Picture> used_pictures_;
  std::exception_ptr error_;
  bool stopping_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace nightjar::sim
