#include "scenarios/processes.h"

#include <memory>

#include "msg/channels.h"
#include "scenarios/estimates_hash.h"
#include "scenarios/reconstruction_node.h"
#include "scenarios/tracker_node.h"
#include "sim/world.h"

namespace nightjar::scenarios {

NodeProcess::Setup reconstruction_process(const esi::ReconstructorConfig& config,
                                          core::Resolution size) {
  return {.inputs = {{kFromSource.sender, {msg::kApsFrame.name, msg::kEvents.name}}},
          .output = kFromReconstruction,
          .make_node = [config, size](msg::Bus& bus) {
            return std::make_shared<ReconstructionNode>(bus, config, size);
          }};
}

NodeProcess::Setup tracker_process(const Scenario& scenario, std::string& estimates_sha256) {
  const sim::World world(scenario.world, scenario.camera, scenario.model,
                         static_cast<std::uint64_t>(scenario.seed), scenario.sensor.imu);
  const auto make_node = [config = scenario.tracker, camera = world.camera_model(),
                          T_body_camera = world.T_body_camera(), &estimates_sha256](msg::Bus& bus) {
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
