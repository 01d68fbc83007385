// What a camera's driver hands over: any bytes at all, cut into packets by a first byte of
// length (in units of four), become ordered lists on the sensor and counted faults.
#include <algorithm>
#include <cstddef>
#include <span>

#include "camera/caer_packets.h"
#include "tests/fuzz/recording_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace nightjar;
  constexpr core::Resolution kSensor{37, 23};
  camera::RecordingIntake intake(kSensor);
  intake.set_place([] { return std::string("fuzz"); });
  camera::RecordingPart part;
  std::span<const std::byte> left = std::as_bytes(std::span(data, size));
  while (!left.empty()) {
    const std::size_t wanted = 4 * std::to_integer<std::size_t>(left[0]);
    left = left.subspan(1);
    const std::size_t taken = std::min(wanted, left.size());
    camera::decode_caer_packet(left.first(taken), intake, part);
    left = left.subspan(taken);
  }
  fuzz::require(std::is_sorted(part.events.begin(), part.events.end(),
                               [](const auto& a, const auto& b) { return a.t < b.t; }));
  for (const core::Event& each : part.events)
    fuzz::require(each.x < kSensor.width_px && each.y < kSensor.height_px);
  for (const camera::RecordedFrame& each : part.frames)
    fuzz::require(each.left_px >= 0 && each.left_px + each.gray.width() <= kSensor.width_px);
  for (const camera::RecordedImu& each : part.imu)
    fuzz::require(each.omega_camera_rad_s.allFinite());
  return 0;
}
