#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

struct mjModel_;
struct mjData_;

namespace nightjar::sim {

/// A MuJoCo model with its state. Poses are in world axes (docs/frames.md).
class Scene {
 public:
  /// Throws std::invalid_argument when the file is missing or MuJoCo refuses it.
  explicit Scene(const std::filesystem::path& model_file);

  const mjModel_* model() const { return model_.get(); }
  mjModel_* model() { return model_.get(); }
  const mjData_* data() const { return data_.get(); }
  mjData_* data() { return data_.get(); }

  /// Number of a named element (`type` is an mjtObj). Throws
  /// std::invalid_argument naming the file when the scene lacks it.
  int id(int type, const std::string& name) const;

  /// Pose of a body's frame, a geom, a site, a camera (MuJoCo's axes: looks along -z).
  Eigen::Isometry3d T_world_body(int body) const;
  Eigen::Isometry3d T_world_geom(int geom) const;
  Eigen::Isometry3d T_world_site(int site) const;
  Eigen::Isometry3d T_world_camera(int camera) const;

  /// Velocity (m/s) of a point that moves with `body`; both in world axes.
  Eigen::Vector3d velocity_at(int body, const Eigen::Vector3d& p_world_m) const;
  /// Angular velocity of `body` in world axes.
  Eigen::Vector3d omega_world(int body) const;

  /// Places a free body at rest; call settle() afterwards.
  void place(const std::string& free_joint, const Eigen::Isometry3d& T_world_body);
  /// Brings all that derives from the state up to date.
  void settle();
  /// One step of the physics. Throws std::runtime_error, naming the simulated time,
  /// when MuJoCo has warned since the scene was made: of numbers that are not finite, of
  /// contacts or geoms left out for want of room.
  void step();

  /// Where everything was `ago_s` before the moment that the poses above are of, 0 to the time
  /// step: on the straight way that the step took it (MuJoCo's Euler and implicit integrators
  /// move a body by its velocity at the step's end; RK4, nearly so). Mocap bodies are where they
  /// are now. Good for drawing; until the next call.
  mjData_* moment(double ago_s);

 private:
  struct DeleteModel {
    void operator()(mjModel_*) const;
  };
  struct DeleteData {
    void operator()(mjData_*) const;
  };

  /// To be called where MuJoCo is about to work out poses.
  void note_posed();

  std::filesystem::path file_;
  std::unique_ptr<mjModel_, DeleteModel> model_;
  std::unique_ptr<mjData_, DeleteData> data_;
  std::unique_ptr<mjData_, DeleteData> moment_;  ///< For moment() alone.
  // Of the poses, which MuJoCo works out before it moves on.
  std::vector<double> posed_qpos_, posed_qvel_;
};

}  // namespace nightjar::sim
