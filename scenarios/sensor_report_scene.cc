#include "scenarios/sensor_report_scene.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/random.h"

namespace nightjar::scenarios {
namespace {

constexpr int kColumnsPerPixel = 4;
constexpr int kWaves = 32;
constexpr double kShortestWavePx = 8;
constexpr double kLongestWavePx = 64;
const double kMeanLog = std::log(0.25);
constexpr double kSigmaLog = 0.4;

struct Wave {
  double kx_rad_px;
  double ky_rad_px;
  double phase_rad;
};

std::vector<Wave> draw_waves(std::uint64_t seed) {
  core::Random random = core::random_stream(seed, "sensor_report_texture");
  constexpr double kTurn = 2 * std::numbers::pi;
  std::vector<Wave> waves;
  for (int i = 0; i < kWaves; ++i) {
    const double wave_px =
        kShortestWavePx * std::pow(kLongestWavePx / kShortestWavePx, core::uniform01(random));
    const double heading_rad = kTurn * core::uniform01(random);
    const double phase_rad = kTurn * core::uniform01(random);
    waves.push_back({kTurn / wave_px * std::cos(heading_rad),
                     kTurn / wave_px * std::sin(heading_rad), phase_rad});
  }
  return waves;
}

/// Adds the wave's cosine to `sum_log`; along a row by turning a pointer.
void add_wave(const Wave& wave, double amplitude_log, core::Image<float>& sum_log) {
  const std::complex<double> turn = std::polar(1.0, wave.kx_rad_px / kColumnsPerPixel);
  for (int y = 0; y < sum_log.height(); ++y) {
    std::complex<double> pointer = std::polar(amplitude_log, wave.ky_rad_px * y + wave.phase_rad);
    for (int x = 0; x < sum_log.width(); ++x) {
      sum_log(x, y) += static_cast<float>(pointer.real());
      pointer *= turn;
    }
  }
}

core::Image<float> texture_lux(core::Resolution size, double white_lux, std::uint64_t seed) {
  core::Image<float> texture(size, static_cast<float>(kMeanLog));
  const double amplitude_log = kSigmaLog * std::sqrt(2.0 / kWaves);
  for (const Wave& wave : draw_waves(seed)) add_wave(wave, amplitude_log, texture);
  for (float& value : texture.pixels())
    value = static_cast<float>(white_lux * std::min(1.0, std::exp(static_cast<double>(value))));
  return texture;
}

int first_row(const core::Image<float>& picture) { return picture.height() / 4; }

}  // namespace

core::Image<float> grey_bars(core::Resolution size, double white_lux) {
  core::Image<float> bars(size);
  const int count = static_cast<int>(kGreyBars.size());
  for (int y = 0; y < size.height_px; ++y)
    for (int x = 0; x < size.width_px; ++x)
      bars(x, y) = static_cast<float>(white_lux * kGreyBars[x * count / size.width_px]);
  return bars;
}

MovingPattern::MovingPattern(core::Resolution size, double white_lux, double speed_px_s,
                             double duration_s, std::uint64_t seed) {
  interval_ = core::from_seconds(1.0 / (kColumnsPerPixel * speed_px_s));
  pictures_ = std::max(2, static_cast<int>(duration_s / core::seconds(interval_)) + 1);
  const core::Resolution strip{kColumnsPerPixel * size.width_px + pictures_,
                               std::max(1, size.height_px / 2)};
  strip_lux_ = texture_lux(strip, white_lux, seed);
  picture_lux_ = grey_bars(size, white_lux);
}

const core::Image<float>& MovingPattern::draw(int index) {
  const int first = first_row(picture_lux_);
  for (int y = 0; y < strip_lux_.height(); ++y)
    for (int x = 0; x < picture_lux_.width(); ++x)
      picture_lux_(x, first + y) = strip_lux_(kColumnsPerPixel * x + index, y);
  return picture_lux_;
}

}  // namespace nightjar::scenarios
