#pragma once

#include "core/config_check.h"

namespace nightjar::sim {

/// How the pixels behave. `by_illuminance` follows the scene's light, `clean`,
/// `bright` and `dim` are fixed, `custom` reads the section `pixel`.
enum class SensorPreset { by_illuminance, clean, bright, dim, custom };

inline constexpr core::Choices<SensorPreset, 5> kSensorPresets{
    {{"by_illuminance", SensorPreset::by_illuminance},
     {"clean", SensorPreset::clean},
     {"bright", SensorPreset::bright},
     {"dim", SensorPreset::dim},
     {"custom", SensorPreset::custom}}};

/// The event pixel. Intensities are on v2e's scale: 255 is a white surface under
/// the scene's light. Defaults are v2e's noisy preset (v2ecore, commit cac6384)
/// plus hot pixels, which v2e lacks.
struct PixelConfig {
  // Contrast thresholds, steps of natural log intensity; v2e has both the same.
  double threshold_on_log = 0.2;
  double threshold_off_log = 0.2;
  double threshold_on_sigma_log = 0.05;   ///< Frozen Gaussian mismatch from pixel to pixel.
  double threshold_off_sigma_log = 0.05;  ///< Both: no threshold falls below 0.01.

  // Photoreceptor.
  double cutoff_hz = 30.0;         ///< Low pass of a white pixel (255); 0 = no low pass.
  double log_linear_below = 20.0;  ///< Linear up to here (0..255), then log; 0 = log only.

  double refractory_us = 0.0;  ///< Held in reset for so long after each event.

  // Leak: drift towards ON. Spread and jitter are v2e's.
  double leak_rate_hz = 0.1;         ///< ON events of the typical still pixel.
  double leak_spread_decades = 0.1;  ///< Frozen, log-normal from pixel to pixel.
  double leak_jitter = 0.1;          ///< Relative deviation from one interval to the next.

  /// v2e's R: a pixel at intensity 0 fires about 0.95 R, half of it ON; white 0.25 R.
  double shot_noise_rate_hz = 5.0;

  // Hot pixels: assumption, between two recordings; a DAVIS346-size sensor had 5
  // of 89,960 at 32 to 163 Hz, a 640x480 one 220 above 20 Hz, up to 5124 Hz.
  double hot_pixel_fraction = 1e-4;
  double hot_pixel_rate_median_hz = 60.0;
  double hot_pixel_rate_sigma_ln = 1.3;  ///< Log-normal: deviation of ln(rate).

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("threshold_on_log", threshold_on_log, 0.01, 2.0);
    v.field("threshold_off_log", threshold_off_log, 0.01, 2.0);
    v.field("threshold_on_sigma_log", threshold_on_sigma_log, 0.0, 0.5);
    v.field("threshold_off_sigma_log", threshold_off_sigma_log, 0.0, 0.5);
    v.field("cutoff_hz", cutoff_hz, 0.0, 1e5);
    v.field("log_linear_below", log_linear_below, 0.0, 128.0);
    v.field("refractory_us", refractory_us, 0.0, 1e6);
    v.field("leak_rate_hz", leak_rate_hz, 0.0, 1000.0);
    v.field("leak_spread_decades", leak_spread_decades, 0.0, 1.0);
    v.field("leak_jitter", leak_jitter, 0.0, 0.25);
    v.field("shot_noise_rate_hz", shot_noise_rate_hz, 0.0, 1000.0);
    v.field("hot_pixel_fraction", hot_pixel_fraction, 0.0, 0.1);
    v.field("hot_pixel_rate_median_hz", hot_pixel_rate_median_hz, 0.01, 1e4);
    v.field("hot_pixel_rate_sigma_ln", hot_pixel_rate_sigma_ln, 0.0, 3.0);
  }
};

/// From pixels to the host: about 12 million events/s at most on a DAVIS346.
struct ReadoutConfig {
  double max_event_rate_hz = 12e6;
  /// Requests that can wait; more are lost. 12,000 wait 1 ms.
  int queue_capacity_events = 12000;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("max_event_rate_hz", max_event_rate_hz, 1e3, 1e9);
    v.field("queue_capacity_events", queue_capacity_events, 1, 100000000);
  }
};

/// The camera's own noise filter (libcaer: on, at 2 ms, where the logic has it).
struct BackgroundActivityConfig {
  bool enabled = false;
  int window_us = 2000;  ///< A neighbour must have fired so recently.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("enabled", enabled);
    v.field("window_us", window_us, 1, 1000000);
  }
};

/// Active pixels. No table of the DAVIS346's was found: all of this is assumed, of
/// the size that small global-shutter sensors have (dynamic range 55 dB).
struct ApsConfig {
  double exposure_ms = 0.0;    ///< 0 = what the light needs: see aps_exposure().
  double interval_ms = 40.0;   ///< From exposure to exposure; longer if the exposure is.
  double full_well_e = 25000;  ///< Electrons at which a pixel saturates.
  /// A white surface in 1 lux for 1 s; 0.5 s of 10 lux fills the well to 80 %.
  double electrons_per_lux_s = 4000;
  double read_noise_e = 44;
  double offset_fpn_e = 100;  ///< Frozen pixel offsets, standard deviation.
  double gain_fpn = 0.01;     ///< Frozen pixel gains, relative standard deviation.
  double black_level = 16;    ///< Code (0..255) of no light.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("exposure_ms", exposure_ms, 0.0, 10000.0);
    v.field("interval_ms", interval_ms, 1.0, 10000.0);
    v.field("full_well_e", full_well_e, 100.0, 1e6);
    v.field("electrons_per_lux_s", electrons_per_lux_s, 0.1, 1e7);
    v.field("read_noise_e", read_noise_e, 0.0, 1e4);
    v.field("offset_fpn_e", offset_fpn_e, 0.0, 1e4);
    v.field("gain_fpn", gain_fpn, 0.0, 0.2);
    v.field("black_level", black_level, 0.0, 128.0);
  }
};

struct SensorConfig {
  SensorPreset preset = SensorPreset::by_illuminance;
  PixelConfig pixel;  ///< Read, written and used only if the preset is `custom`.
  ReadoutConfig readout;
  BackgroundActivityConfig background_activity_filter;
  ApsConfig aps;

  /// With any other preset than `custom` a section `pixel` is an unknown key, so
  /// that no value in a file stays without effect.
  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("preset", preset, kSensorPresets);
    if (preset == SensorPreset::custom) v.section("pixel", pixel);
    v.section("readout", readout);
    v.section("background_activity_filter", background_activity_filter);
    v.section("aps", aps);
  }
};

/// The pixels of a preset. `clean` is v2e's clean preset, `bright` its command-line
/// defaults, `dim` its noisy preset, meant at 5 lux; all but `clean` with hot pixels.
///
/// `by_illuminance` is an assumption, since no table of rate against lux was found
/// for this sensor: `dim` at 5 lux, `bright` at 1000 lux, straight lines in log-log
/// between them. Darker than 5 lux the cutoff falls as the light does (as it does
/// from pixel to pixel) and shot noise rises to the 17 Hz that IEBCS measured at
/// 0.1 lux. Outside 0.1 to 1000 lux the nearer end holds.
///
/// Throws std::invalid_argument for `custom`, and for an illuminance that is not > 0.
PixelConfig preset_pixel(SensorPreset preset, double illuminance_lux);

/// What `config` really uses: its own section for `custom`, else the preset.
PixelConfig effective_pixel(const SensorConfig& config, double illuminance_lux);

}  // namespace nightjar::sim
