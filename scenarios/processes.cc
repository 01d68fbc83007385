#include "scenarios/processes.h"

#include <memory>

#include "msg/channels.h"
#include "scenarios/estimates_hash.h"
#include "scenarios/intrinsics.h"
#include "scenarios/mount.h"
#include "scenarios/reconstruction_node.h"
#include "scenarios/tracker_node.h"
#include "sim/world.h"

namespace nightjar::scenarios {
namespace {

Eigen::Isometry3d mounting(const Scenario& scenario) {
  if (scenario.source.type == camera::SourceType::caer) return T_body_camera(scenario.source.mount);
  const sim::World world(scenario.world, scenario.camera, scenario.model,
                         static_cast<std::uint64_t>(scenario.seed), scenario.sensor.imu);
  return world.T_body_camera();
}

}  // namespace

NodeProcess::Setup reconstruction_process(const esi::ReconstructorConfig& config,
                                          core::Resolution size) {
  return {.inputs = {{kFromSource.sender, {msg::kApsFrame.name, msg::kEvents.name}}},
          .output = kFromReconstruction,
          .make_node = [config, size](msg::Bus& bus) {
            return std::make_shared<ReconstructionNode>(bus, config, size);
          }};
}

NodeProcess::Setup tracker_process(const Scenario& scenario, std::string& estimates_sha256) {
  const auto make_node = [config = scenario.tracker, camera = camera_model(scenario),
                          T_body_camera = mounting(scenario), &estimates_sha256](msg::Bus& bus) {
    auto hash = std::make_shared<EstimatesHash>();
    estimates_sha256 = hash->hex();
    bus.subscribe(msg::kTargetEstimate, [hash, &estimates_sha256](const core::TargetEstimate& e) {
      hash->add(e);
      estimates_sha256 = hash->hex();
    });
    return std::make_shared<TrackerNode>(bus, config, camera, T_body_camera);
  };
  return {.inputs = {{kFromSource.sender, {msg::kVehicleState.name}}, kFromReconstruction},
          .output = kFromTracker,
          .make_node = make_node};
}

}  // namespace nightjar::scenarios
