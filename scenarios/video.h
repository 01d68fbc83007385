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

  /// Draws the view from outside for the frame at the world's time, if one is due.
  /// Comes after add() of all earlier pictures.
  void draw_chase(sim::World& world);

  /// Brings the video up to the time of this picture, whose messages came before: a
  /// frame for every 40 ms that have passed, so that it runs in real time whatever
  /// the interval between pictures is.
  void add(const PictureRecord& record);

  /// Completes the file. Throws std::runtime_error unless it reads back with every
  /// frame that was added, one at least.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nightjar::scenarios
