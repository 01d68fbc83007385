#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "core/config_check.h"
#include "core/event.h"

namespace nightjar::sim {

/// How a camera is carried over its target.
enum class CarryMotion {
  hover,  ///< A slide in the first second, then a few pixels of drift.
  slow,   ///< About 60 px/s.
  fast,   ///< About 350 px/s.
  shake   ///< As `hover`, with 5 to 8 tilts a second of 1.5 degrees.
};

inline constexpr core::Choices<CarryMotion, 4> kCarryMotions{{{"hover", CarryMotion::hover},
                                                              {"slow", CarryMotion::slow},
                                                              {"fast", CarryMotion::fast},
                                                              {"shake", CarryMotion::shake}}};

/// A smooth seeded path of a camera that looks down on a target: sums of sine waves in
/// place, tilt and heading. Image speeds above hold 1.2 m over the target, f = 297 px.
class CarriedPath {
 public:
  CarriedPath(CarryMotion motion, std::uint64_t seed);

  /// Camera axes (x right, y down, z forward) in those of the target: z up, the camera
  /// upright when the picture's top points along x.
  Eigen::Isometry3d T_target_camera(core::Time t) const;

 private:
  struct Wave {
    double amplitude, omega_rad_s, phase_rad;
  };
  using Waves = std::array<Wave, 3>;
  enum Axis { kX, kY, kHeight, kRoll, kPitch, kYaw, kAxes };

  double sum(Axis axis, double t_s) const;

  std::array<Waves, kAxes> waves_;
  double height_m_;
  double heading_rad_;
  Eigen::Vector2d slide_m_;  ///< Where the first second begins, from where it ends.
};

}  // namespace nightjar::sim
