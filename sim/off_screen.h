#pragma once

#include <memory>
#include <string>

#include "core/event.h"

struct mjModel_;
struct mjrContext_;
struct mjvScene_;

namespace nightjar::sim {

/// A picture in memory that OpenGL draws into: Mesa's OSMesa with its software renderer,
/// and MuJoCo's resources of one model.
///
/// Mesa reads its settings from the environment before the first context of a process: the
/// first of these sets GALLIVM_PERF, and LP_NUM_THREADS where it is not set.
class OffScreen {
 public:
  /// `color_format`: OpenGL's internal format of the picture. Throws std::runtime_error when
  /// OSMesa is missing something, cannot draw in that format or is not llvmpipe (Mesa's other
  /// software renderer is some sixty times slower).
  OffScreen(const mjModel_& model, core::Resolution size, unsigned color_format);
  ~OffScreen();
  OffScreen(const OffScreen&) = delete;
  OffScreen& operator=(const OffScreen&) = delete;

  core::Resolution size() const { return size_; }
  /// What draws, as OpenGL names it.
  const std::string& description() const { return description_; }
  mjrContext_& resources() { return *resources_; }

  /// Has this thread's OpenGL calls go here while it lives; one at a time in all threads.
  class Current {
   public:
    explicit Current(OffScreen& off_screen);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    OffScreen& off_screen_;
  };

  /// Draws; current in this thread. MuJoCo notes the geoms' order in `geoms`.
  void render(mjvScene_& geoms);

 private:
  class Context;
  void make_frame_buffer(unsigned color_format);

  core::Resolution size_;
  std::unique_ptr<Context> context_;
  std::string description_;
  std::unique_ptr<mjrContext_> resources_;
  unsigned own_frame_buffer_ = 0;  ///< MuJoCo's, unused.
  unsigned color_ = 0, depth_ = 0;
};

}  // namespace nightjar::sim
