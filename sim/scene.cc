#include "sim/scene.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <array>
#include <stdexcept>

namespace nightjar::sim {
namespace {

Eigen::Isometry3d isometry(const mjtNum* position, const mjtNum* row_major_3x3) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(position[0], position[1], position[2]);
  T.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(row_major_3x3);
  return T;
}

/// MuJoCo's own handlers write to the terminal and to MUJOCO_LOG.TXT, and after an
/// error they wait for a key.
void install_handlers() {
  mju_user_error = [](const char* text) {
    throw std::runtime_error(fmt::format("MuJoCo: {}", text));
  };
  mju_user_warning = [](const char*) {};  // counted in mjData::warning, see check_warnings()
}

/// `before_s`: when the step began; MuJoCo sets its clock back when it diverges.
void check_warnings(const mjData& data, double before_s) {
  for (int i = 0; i < mjNWARNING; ++i)
    if (data.warning[i].number > 0)
      throw std::runtime_error(fmt::format("MuJoCo: after {:.6f} s: {}", before_s,
                                           mju_warningText(i, data.warning[i].lastinfo)));
}

}  // namespace

void Scene::DeleteModel::operator()(mjModel_* m) const { mj_deleteModel(m); }
void Scene::DeleteData::operator()(mjData_* d) const { mj_deleteData(d); }

Scene::Scene(const std::filesystem::path& model_file) : file_(model_file) {
  install_handlers();
  std::array<char, 500> error{};
  model_.reset(mj_loadXML(model_file.c_str(), nullptr, error.data(), error.size()));
  if (!model_) {
    std::string text = error.data();
    while (!text.empty() && text.back() == '\n') text.pop_back();
    for (char& c : text)
      if (c == '\n') c = ' ';
    throw std::invalid_argument(fmt::format("{}: {}", model_file.string(), text));
  }
  data_.reset(mj_makeData(model_.get()));
  settle();
}

int Scene::id(int type, const std::string& name) const {
  const int found = mj_name2id(model_.get(), type, name.c_str());
  if (found < 0)
    throw std::invalid_argument(fmt::format("{}: the scene has no {} named '{}'", file_.string(),
                                            mju_type2Str(type), name));
  return found;
}

Eigen::Isometry3d Scene::T_world_body(int body) const {
  return isometry(data_->xpos + 3 * body, data_->xmat + 9 * body);
}

Eigen::Isometry3d Scene::T_world_geom(int geom) const {
  return isometry(data_->geom_xpos + 3 * geom, data_->geom_xmat + 9 * geom);
}

Eigen::Isometry3d Scene::T_world_site(int site) const {
  return isometry(data_->site_xpos + 3 * site, data_->site_xmat + 9 * site);
}

Eigen::Isometry3d Scene::T_world_camera(int camera) const {
  return isometry(data_->cam_xpos + 3 * camera, data_->cam_xmat + 9 * camera);
}

Eigen::Vector3d Scene::omega_world(int body) const {
  std::array<mjtNum, 6> v{};
  mj_objectVelocity(model_.get(), data_.get(), mjOBJ_XBODY, body, v.data(), 0);
  return {v[0], v[1], v[2]};
}

Eigen::Vector3d Scene::velocity_at(int body, const Eigen::Vector3d& p_world) const {
  std::array<mjtNum, 6> v{};
  mj_objectVelocity(model_.get(), data_.get(), mjOBJ_XBODY, body, v.data(), 0);
  const Eigen::Vector3d omega(v[0], v[1], v[2]), linear(v[3], v[4], v[5]);
  return linear + omega.cross(p_world - T_world_body(body).translation());
}

void Scene::place(const std::string& free_joint, const Eigen::Isometry3d& T) {
  const int joint = id(mjOBJ_JOINT, free_joint);
  if (model_->jnt_type[joint] != mjJNT_FREE)
    throw std::invalid_argument(
        fmt::format("{}: joint '{}' is not free", file_.string(), free_joint));
  const Eigen::Quaterniond q(T.linear());
  mjtNum* qpos = data_->qpos + model_->jnt_qposadr[joint];
  const std::array<double, 7> pose = {
      T.translation().x(), T.translation().y(), T.translation().z(), q.w(), q.x(), q.y(), q.z()};
  mju_copy(qpos, pose.data(), 7);
  mju_zero(data_->qvel + model_->jnt_dofadr[joint], 6);
}

void Scene::settle() {
  note_posed();
  mj_forward(model_.get(), data_.get());
}

void Scene::note_posed() {
  posed_qpos_.assign(data_->qpos, data_->qpos + model_->nq);
  posed_qvel_.assign(data_->qvel, data_->qvel + model_->nv);
}

mjData* Scene::moment(double ago_s) {
  if (!moment_) moment_.reset(mj_makeData(model_.get()));
  mju_copy(moment_->qpos, posed_qpos_.data(), model_->nq);
  mj_integratePos(model_.get(), moment_->qpos, posed_qvel_.data(), -ago_s);
  mju_copy(moment_->mocap_pos, data_->mocap_pos, 3 * model_->nmocap);
  mju_copy(moment_->mocap_quat, data_->mocap_quat, 4 * model_->nmocap);
  mj_kinematics(model_.get(), moment_.get());
  mj_comPos(model_.get(), moment_.get());  // lights and cameras may follow a centre of mass
  mj_camlight(model_.get(), moment_.get());
  mj_tendon(model_.get(), moment_.get());
  return moment_.get();
}

void Scene::step() {
  const double before_s = data_->time;
  note_posed();
  mj_step(model_.get(), data_.get());
  check_warnings(*data_, before_s);
}

}  // namespace nightjar::sim
