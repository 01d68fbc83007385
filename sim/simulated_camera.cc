#include "sim/simulated_camera.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace nightjar::sim {
namespace {

/// Takes out the first elements, those for which `belongs`.
template <class T, class Belongs>
std::vector<T> take_first(std::vector<T>& all, Belongs belongs) {
  const auto later = std::ranges::find_if_not(all, belongs);
  std::vector<T> rest(std::make_move_iterator(later), std::make_move_iterator(all.end()));
  all.erase(later, all.end());
  return std::exchange(all, std::move(rest));
}

}  // namespace

SimulatedCamera::SimulatedCamera(const SensorConfig& config, core::Resolution size,
                                 double illuminance_lux, std::uint64_t seed)
    : emulator_(effective_pixel(config, illuminance_lux), size, illuminance_lux, seed),
      readout_(config.readout, size),
      filter_(config.background_activity_filter, size),
      aps_(config.aps, size, illuminance_lux, seed) {}

void SimulatedCamera::expose(core::Time t, const core::Image<float>& luminance_lux) {
  requests_.clear();
  emulating_([&] { emulator_.step(t, luminance_lux, requests_); });
  reading_out_([&] { readout_.step(t, requests_, events_); });
  if (auto frame = exposing_([&] { return aps_.add(t, luminance_lux); }))
    frames_.push_back(std::move(*frame));
}

CameraOutput SimulatedCamera::take(core::Time end) {
  CameraOutput output;
  output.packet = {std::exchange(packet_begin_, end), end,
                   take_first(events_, [end](const core::Event& e) { return e.t <= end; })};
  filter_.filter(output.packet.events);
  output.frames =
      take_first(frames_, [end](const core::ApsFrame& f) { return f.exposure_end <= end; });
  return output;
}

std::vector<core::StageTime> SimulatedCamera::stage_times() const {
  return {emulating_.time(), reading_out_.time(), exposing_.time()};
}

}  // namespace nightjar::sim
