#pragma once

#include <functional>
#include <vector>

#include "core/camera_model.h"
#include "esi/esi.h"
#include "msg/bus.h"
#include "scenarios/picture_record.h"
#include "sim/simulation.h"
#include "tracker/tracker.h"

namespace nightjar::scenarios {

// The modules of the loop, joined to each other by messages alone. They act within
// Bus::dispatch(); none knows who sends and who listens.

/// Setpoints in; truth, vehicle state, frames and events out.
class SimulationNode {
 public:
  SimulationNode(msg::Bus& bus, sim::Simulation& simulation);

  /// Fixes the setpoint to fly next: the last that came.
  void take_setpoint() { flown_ = latest_; }
  /// Flies one packet under it. Touches no bus, so the messages of the packet before
  /// may be handled meanwhile.
  void advance() { step_ = simulation_.advance(flown_); }
  /// Publishes what advance() gave. Truth and vehicle state go first: whoever handles
  /// the picture made of the events has them by then.
  void publish();

  const sim::SimulationStep& step() const { return step_; }

 private:
  msg::Bus& bus_;
  sim::Simulation& simulation_;
  core::AttitudeSetpoint latest_;
  core::AttitudeSetpoint flown_;
  sim::SimulationStep step_;
};

/// Event packets in, a picture at the end of each out.
class ReconstructionNode {
 public:
  ReconstructionNode(msg::Bus& bus, const esi::EsiConfig& config, core::Resolution size);

 private:
  esi::Esi esi_;
  core::Picture picture_;
};

/// Vehicle states and pictures in; detections, estimate, setpoint and steps of the
/// mission out, in that order.
class TrackerNode {
 public:
  TrackerNode(msg::Bus& bus, const tracker::TrackerConfig& config,
              const core::CameraModel& camera, const Eigen::Isometry3d& T_body_camera);

 private:
  tracker::Tracker tracker_;
};

/// Gathers what belongs to one picture. A picture's record is whole with its
/// setpoint; `on_record` is called then.
class RecordNode {
 public:
  using OnRecord = std::function<void(const PictureRecord&)>;

  RecordNode(msg::Bus& bus, OnRecord on_record);

 private:
  PictureRecord record_;
  OnRecord on_record_;
};

}  // namespace nightjar::scenarios
