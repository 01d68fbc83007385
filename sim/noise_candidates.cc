#include "sim/noise_candidates.h"

#include <tuple>

namespace nightjar::sim {

NoiseCandidates::NoiseCandidates(const PixelConfig& config,
                                 std::span<const float> thresholds_on_log,
                                 std::span<const float> thresholds_off_log, std::uint64_t seed)
    : pixels_(static_cast<std::uint32_t>(thresholds_on_log.size())),
      hot_pixels_(draw_hot_pixels(config, pixels_, seed)),
      shot_on_(shot_noise_rates_hz(config.shot_noise_rate_hz, config.threshold_on_log,
                                   thresholds_on_log),
               core::random_stream(seed, "shot_on")),
      shot_off_(shot_noise_rates_hz(config.shot_noise_rate_hz, config.threshold_off_log,
                                    thresholds_off_log),
                core::random_stream(seed, "shot_off")),
      hot_(hot_pixels_.rates_hz, core::random_stream(seed, "hot_pixel_time")) {}

void NoiseCandidates::start(core::Time t) {
  for (PointProcess* process : {&shot_on_, &shot_off_, &hot_}) process->start(t);
}

std::span<NoiseCandidate> NoiseCandidates::draw(core::Time until) {
  candidates_.clear();
  draw(shot_on_, until, NoiseCandidate::shot_on);
  draw(shot_off_, until, NoiseCandidate::shot_off);
  draw(hot_, until, NoiseCandidate::hot);
  order_.sort(
      candidates_, pixels_, [](const NoiseCandidate& c) -> std::uint64_t { return c.pixel; },
      [](const NoiseCandidate& a, const NoiseCandidate& b) {
        return std::tie(a.pixel, a.t_us, a.kind) < std::tie(b.pixel, b.t_us, b.kind);
      });
  return candidates_;
}

void NoiseCandidates::draw(PointProcess& process, core::Time until, NoiseCandidate::Kind kind) {
  points_.clear();
  process.draw(until, points_);
  for (const NoisePoint& point : points_) {
    const std::uint32_t pixel =
        kind == NoiseCandidate::hot ? hot_pixels_.pixels[point.source] : point.source;
    candidates_.push_back({point.t_us, pixel, point.mark, kind});
  }
}

}  // namespace nightjar::sim
