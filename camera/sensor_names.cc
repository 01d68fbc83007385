#include "camera/sensor_names.h"

#include <algorithm>
#include <array>

namespace nightjar::camera {
namespace {

struct Sensor {
  std::string_view name;
  core::Resolution size;
};

// iniVation's cameras. Of those with one size, the first is the commonest.
constexpr std::array<Sensor, 7> kSensors = {{{"DAVIS346", {346, 260}},
                                             {"DAVIS240", {240, 180}},
                                             {"DAVIS640", {640, 480}},
                                             {"DAVIS208", {208, 192}},
                                             {"DVS128", {128, 128}},
                                             {"DAVIS128", {128, 128}},
                                             {"DVXPLORER", {640, 480}}}};

}  // namespace

std::optional<core::Resolution> sensor_of(std::string_view name) {
  std::string upper(name);
  std::transform(upper.begin(), upper.end(), upper.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  for (const Sensor& sensor : kSensors)
    if (upper.find(sensor.name) != std::string::npos) return sensor.size;
  return std::nullopt;
}

std::string name_of(core::Resolution sensor) {
  const auto* found = std::find_if(kSensors.begin(), kSensors.end(),
                                   [&](const Sensor& each) { return each.size == sensor; });
  return found == kSensors.end() ? std::string() : std::string(found->name);
}

}  // namespace nightjar::camera
