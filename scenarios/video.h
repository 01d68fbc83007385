#pragma once

#include <memory>

#include "core/camera_model.h"
#include "msg/bus.h"
#include "scenarios/output_folder.h"
#include "scenarios/picture_record.h"
#include "sim/world.h"

namespace nightjar::scenarios {

/// Writes run.mp4, 25 frames a second: what a frame camera sees, the events, the
/// reconstructed picture with the tag, and a view from outside.
class Video {
 public:
  /// Listens to events, frames and pictures on `bus`, which it must outlive.
  /// Throws std::runtime_error when no video can be written there.
  Video(msg::Bus& bus, OutputFolder& folder, const core::CameraModel& camera);
  ~Video();

  /// Whether the picture at `t` becomes a frame of the video.
  static bool is_due(core::Time t);

  /// Draws the view from outside for the frame at the world's time, if one is due.
  void draw_chase(sim::World& world);

  /// Adds the frame of this picture, if one is due; its messages came before.
  void add(const PictureRecord& record);

  /// Completes the file.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nightjar::scenarios
