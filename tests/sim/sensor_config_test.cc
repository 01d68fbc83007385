#include "sim/sensor_config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace nightjar::sim {
namespace {

/// The names of what a visit offers, sections only.
struct Sections {
  template <class T>
  void field(const char*, T&, double, double, const core::Origin& = {}) {}
  template <class T>
  void field(const char*, T&, const core::Origin& = {}) {}
  template <class Enum, std::size_t N>
  void choice(const char*, Enum&, const core::Choices<Enum, N>&, const core::Origin& = {}) {}
  template <class Config>
  void section(const char* name, Config&) {
    names.emplace_back(name);
  }
  std::vector<std::string> names;
};

std::vector<std::string> sections(SensorPreset preset) {
  SensorConfig config;
  config.preset = preset;
  Sections visitor;
  config.visit(visitor);
  return visitor.names;
}

TEST(SensorConfig, defaults_and_presets_are_within_their_ranges) {
  EXPECT_NO_THROW(core::check_config(SensorConfig{}, "sensor"));
  for (const SensorPreset preset : {SensorPreset::clean, SensorPreset::bright, SensorPreset::dim})
    EXPECT_NO_THROW(core::check_config(preset_pixel(preset, 5), "pixel"));
  for (double lux = 1e-3; lux < 1e6; lux *= 2)
    EXPECT_NO_THROW(core::check_config(preset_pixel(SensorPreset::by_illuminance, lux), "pixel"));
}

TEST(SensorConfig, the_presets_are_v2es) {
  // v2ecore, cac6384: threshold, mismatch, cutoff, leak, shot noise, refractory time.
  const auto values = [](SensorPreset preset) {
    const PixelConfig p = preset_pixel(preset, 5);
    EXPECT_EQ(p.threshold_on_log, p.threshold_off_log);
    EXPECT_EQ(p.threshold_on_sigma_log, p.threshold_off_sigma_log);
    return std::vector<double>{p.threshold_on_log, p.threshold_on_sigma_log, p.cutoff_hz,
                               p.leak_rate_hz,     p.shot_noise_rate_hz,     p.refractory_us};
  };
  EXPECT_EQ(values(SensorPreset::clean), (std::vector{0.2, 0.02, 0.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(values(SensorPreset::bright), (std::vector{0.2, 0.03, 300.0, 0.01, 0.001, 500.0}));
  EXPECT_EQ(values(SensorPreset::dim), (std::vector{0.2, 0.05, 30.0, 0.1, 5.0, 0.0}));
}

TEST(SensorConfig, a_pixel_section_exists_only_where_it_has_an_effect) {
  for (const SensorPreset preset :
       {SensorPreset::by_illuminance, SensorPreset::clean, SensorPreset::bright, SensorPreset::dim})
    EXPECT_EQ(std::ranges::count(sections(preset), "pixel"), 0);
  EXPECT_EQ(std::ranges::count(sections(SensorPreset::custom), "pixel"), 1);
}

TEST(SensorConfig, custom_pixels_are_used_as_they_are) {
  SensorConfig config;
  config.pixel.threshold_on_log = 0.33;
  EXPECT_EQ(effective_pixel(config, 5).threshold_on_log, 0.2);
  config.preset = SensorPreset::custom;
  EXPECT_EQ(effective_pixel(config, 5).threshold_on_log, 0.33);
  EXPECT_THROW(preset_pixel(SensorPreset::custom, 5), std::invalid_argument);
}

TEST(SensorConfig, light_leads_from_dim_to_bright) {
  const auto at = [](double lux) { return preset_pixel(SensorPreset::by_illuminance, lux); };
  const PixelConfig dim = preset_pixel(SensorPreset::dim, 5);
  const PixelConfig bright = preset_pixel(SensorPreset::bright, 5);
  for (double PixelConfig::*member :
       {&PixelConfig::threshold_on_sigma_log, &PixelConfig::threshold_off_sigma_log,
        &PixelConfig::cutoff_hz, &PixelConfig::refractory_us, &PixelConfig::leak_rate_hz,
        &PixelConfig::shot_noise_rate_hz}) {
    EXPECT_NEAR(at(5).*member, dim.*member, 1e-9);  // rounding of pow
    EXPECT_NEAR(at(1000).*member, bright.*member, 1e-9);
    EXPECT_EQ(at(1e5).*member, at(1000).*member);
    EXPECT_EQ(at(0.01).*member, at(0.1).*member);
  }
  double cutoff_hz = 0, shot_hz = 1e9;
  for (double lux = 0.1; lux <= 1000; lux *= 1.3) {
    EXPECT_GT(at(lux).cutoff_hz, cutoff_hz);
    EXPECT_LT(at(lux).shot_noise_rate_hz, shot_hz);
    cutoff_hz = at(lux).cutoff_hz;
    shot_hz = at(lux).shot_noise_rate_hz;
  }
  EXPECT_NEAR(at(2).cutoff_hz, 12, 1e-9);  // proportional to the light
}

TEST(SensorConfig, light_must_be_there) {
  for (const double lux : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(preset_pixel(SensorPreset::by_illuminance, lux), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::sim
