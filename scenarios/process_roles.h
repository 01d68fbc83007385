#pragma once

#include <string>
#include <vector>

#include "msg/channels.h"

/// Who sends what when the loop runs as processes. The names stand in msg::StepMark::sender.
namespace nightjar::scenarios {

inline constexpr const char* kSource = "source";
inline constexpr const char* kReconstruction = "reconstruction";
inline constexpr const char* kTracker = "tracker";

/// Seen by every process of this computer and by no other: ttl=0 keeps it off the network.
inline constexpr const char* kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";

/// What one process sends, or the part of it that another listens to.
struct Sending {
  std::string sender;
  std::vector<std::string> channels;
};

/// Events last: they close what a source has for a packet.
inline const Sending kFromSource = {
    kSource,
    {msg::kTruth.name, msg::kVehicleState.name, msg::kSensor.name, msg::kTrigger.name,
     msg::kImu.name, msg::kApsFrame.name, msg::kEvents.name}};
inline const Sending kFromReconstruction = {kReconstruction, {msg::kPicture.name}};
inline const Sending kFromTracker = {kTracker,
                                     {msg::kTagDetections.name, msg::kTargetEstimate.name,
                                      msg::kMissionTransition.name, msg::kAttitudeSetpoint.name}};

}  // namespace nightjar::scenarios
