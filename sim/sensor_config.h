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

// Where the numbers come from.
inline constexpr const char* kFromV2eNoisy = "v2e (v2ecore, cac6384), noisy preset";
inline constexpr const char* kFromV2e = "v2e (v2ecore, cac6384)";
inline constexpr const char* kFromHotPixels =
    "assumption: between a DAVIS346-size recording (5 of 89,960 at 32 to 163 Hz) and a 640x480 one "
    "(220 above 20 Hz, up to 5124 Hz)";
inline constexpr const char* kFromLibcaer = "libcaer's default (src/davis_common.h, f85411a)";
inline constexpr const char* kFromSmallSensors =
    "assumption: as small global-shutter sensors have it; no table of the DAVIS346's was found";
inline constexpr const char* kFromMpu9250 = "MPU-9250 data sheet (PS-MPU-9250A-01, rev. 1.0)";

/// The event pixel. Intensities are on v2e's scale: 255 is a white surface under
/// the scene's light. Defaults are v2e's noisy preset (v2ecore, commit cac6384)
/// plus hot pixels, which v2e lacks.
struct PixelConfig {
  /// Contrast thresholds, steps of natural log intensity. v2e, and so every preset, has
  /// both the same; a real DAVIS346 gave 1.7 OFF events for each ON one. Counts go with
  /// 1/threshold, so `custom` gets there with threshold_on_log 1.7 times
  /// threshold_off_log, for instance 0.26 and 0.153, whose geometric mean is 0.2.
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

  double hot_pixel_fraction = 1e-4;
  double hot_pixel_rate_median_hz = 60.0;
  double hot_pixel_rate_sigma_ln = 1.3;  ///< Log-normal: deviation of ln(rate).

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("threshold_on_log", threshold_on_log, 0.01, 2.0, {kFromV2eNoisy});
    v.field("threshold_off_log", threshold_off_log, 0.01, 2.0, {kFromV2eNoisy});
    v.field("threshold_on_sigma_log", threshold_on_sigma_log, 0.0, 0.5, {kFromV2eNoisy});
    v.field("threshold_off_sigma_log", threshold_off_sigma_log, 0.0, 0.5, {kFromV2eNoisy});
    v.field("cutoff_hz", cutoff_hz, 0.0, 1e5, {kFromV2eNoisy});
    v.field("log_linear_below", log_linear_below, 0.0, 128.0, {kFromV2e, "of 255"});
    v.field("refractory_us", refractory_us, 0.0, 1e6, {kFromV2eNoisy});
    v.field("leak_rate_hz", leak_rate_hz, 0.0, 1000.0, {kFromV2eNoisy});
    v.field("leak_spread_decades", leak_spread_decades, 0.0, 1.0, {kFromV2e});
    v.field("leak_jitter", leak_jitter, 0.0, 0.25, {kFromV2e, core::kPureNumber});
    v.field("shot_noise_rate_hz", shot_noise_rate_hz, 0.0, 1000.0, {kFromV2eNoisy});
    v.field("hot_pixel_fraction", hot_pixel_fraction, 0.0, 0.1,
            {kFromHotPixels, core::kPureNumber});
    v.field("hot_pixel_rate_median_hz", hot_pixel_rate_median_hz, 0.01, 1e4, {kFromHotPixels});
    v.field("hot_pixel_rate_sigma_ln", hot_pixel_rate_sigma_ln, 0.0, 3.0, {kFromHotPixels});
  }
};

/// From pixels to the host.
struct ReadoutConfig {
  double max_event_rate_hz = 12e6;
  /// Requests that can wait; more are lost.
  int queue_capacity_events = 12000;

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("max_event_rate_hz", max_event_rate_hz, 1e3, 1e9,
            {"ESI paper: DAVIS346, 12 million events/s"});
    v.field("queue_capacity_events", queue_capacity_events, 1, 100000000,
            {"assumption: what is read out in 1 ms"});
  }
};

/// The camera's own noise filter.
struct BackgroundActivityConfig {
  bool enabled = false;
  int window_us = 2000;  ///< A neighbour must have fired so recently.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("enabled", enabled,
            {"assumption: off, to see the raw sensor; libcaer switches it on where there is one"});
    v.field("window_us", window_us, 1, 1000000, {kFromLibcaer});
  }
};

/// Grey levels that a frame is handed over with; the converter has 10 bits.
enum class ApsBits { eight = 8, ten = 10 };

inline constexpr core::Choices<ApsBits, 2> kApsBits{{{"8", ApsBits::eight}, {"10", ApsBits::ten}}};

/// Active pixels. Their dynamic range follows from the defaults: full well over read
/// noise, 20 log10(25000 / 44) = 55 dB.
struct ApsConfig {
  double exposure_ms = 0.0;    ///< 0 = what the light needs: see aps_exposure().
  double interval_ms = 40.0;   ///< From exposure to exposure; longer if the exposure is.
  double full_well_e = 25000;  ///< Electrons at which a pixel saturates.
  /// A white surface in 1 lux for 1 s; 0.5 s of 10 lux fills the well to 80 %.
  double electrons_per_lux_s = 4000;
  double read_noise_e = 44;
  double offset_fpn_e = 100;      ///< Frozen pixel offsets, standard deviation.
  double gain_fpn = 0.01;         ///< Frozen pixel gains, relative standard deviation.
  double black_level = 16;        ///< Grey level of no light, of 255 whatever the bits.
  ApsBits bits = ApsBits::eight;  ///< 8 drops the converter's lowest two.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("exposure_ms", exposure_ms, 0.0, 10000.0,
            {"assumption: 5 lux s, at most 0.5 s as in the ESI paper at 2 to 10 lux"});
    v.field("interval_ms", interval_ms, 1.0, 10000.0, {kFromLibcaer});
    v.field("full_well_e", full_well_e, 100.0, 1e6, {kFromSmallSensors});
    v.field("electrons_per_lux_s", electrons_per_lux_s, 0.1, 1e7,
            {kFromSmallSensors, "electrons/(lux s)"});
    v.field("read_noise_e", read_noise_e, 0.0, 1e4, {kFromSmallSensors});
    v.field("offset_fpn_e", offset_fpn_e, 0.0, 1e4, {kFromSmallSensors});
    v.field("gain_fpn", gain_fpn, 0.0, 0.2, {kFromSmallSensors, core::kPureNumber});
    v.field("black_level", black_level, 0.0, 128.0, {kFromSmallSensors, "of 255"});
    v.choice("bits", bits, kApsBits,
             {"libcaer: the converter has 10 (APS_ADC_DEPTH), frames are shown with 8"});
  }
};

/// The inertial sensor in the camera: three gyroscopes and three accelerometers with
/// 16 bits over their range. libcaer knows it as an MPU-9250, whose inertial half is an
/// MPU-6500. Each axis: truth + bias + drift + white noise. Units are the data sheet's,
/// mg = 0.001 g, g = 9.80665 m/s^2; samples are in SI units.
struct ImuConfig {
  double gyro_range_deg_s = 500.0;  ///< Beyond it the reading saturates.
  double accel_range_g = 4.0;
  double gyro_noise_deg_s_sqrt_hz = 0.01;  ///< White, one-sided density.
  double accel_noise_ug_sqrt_hz = 300.0;
  double gyro_bias_sigma_deg_s = 1.7;  ///< Drawn once a run, constant.
  double accel_bias_sigma_mg = 20.0;
  double gyro_drift_sigma_deg_s = 0.005;  ///< Stationary first-order Gauss-Markov.
  double accel_drift_sigma_mg = 0.2;
  double drift_correlation_s = 100.0;

  template <class Visitor>
  void visit(Visitor& v) {
    constexpr const char* kTolerance =
        "MPU-9250 data sheet: tolerance 5 deg/s and 60 mg; assumption: that is 3 sigma";
    constexpr const char* kDrift =
        "assumption: as consumer MEMS sensors have it (18 deg/h, 0.2 mg); not in the data sheet";
    v.field("gyro_range_deg_s", gyro_range_deg_s, 10.0, 10000.0, {kFromLibcaer});
    v.field("accel_range_g", accel_range_g, 0.1, 1000.0, {kFromLibcaer});
    v.field("gyro_noise_deg_s_sqrt_hz", gyro_noise_deg_s_sqrt_hz, 0.0, 1.0, {kFromMpu9250});
    v.field("accel_noise_ug_sqrt_hz", accel_noise_ug_sqrt_hz, 0.0, 1e5, {kFromMpu9250});
    v.field("gyro_bias_sigma_deg_s", gyro_bias_sigma_deg_s, 0.0, 50.0, {kTolerance});
    v.field("accel_bias_sigma_mg", accel_bias_sigma_mg, 0.0, 1000.0, {kTolerance});
    v.field("gyro_drift_sigma_deg_s", gyro_drift_sigma_deg_s, 0.0, 10.0, {kDrift});
    v.field("accel_drift_sigma_mg", accel_drift_sigma_mg, 0.0, 100.0, {kDrift});
    v.field("drift_correlation_s", drift_correlation_s, 0.01, 1e5, {kDrift});
  }
};

struct SensorConfig {
  SensorPreset preset = SensorPreset::by_illuminance;
  PixelConfig pixel;  ///< Read, written and used only if the preset is `custom`.
  ReadoutConfig readout;
  BackgroundActivityConfig background_activity_filter;
  ApsConfig aps;
  ImuConfig imu;

  /// With any other preset than `custom` a section `pixel` is an unknown key, so
  /// that no value in a file stays without effect.
  template <class Visitor>
  void visit(Visitor& v) {
    v.choice("preset", preset, kSensorPresets,
             {"v2e's presets; assumption: interpolated in between, see preset_pixel()"});
    if (preset == SensorPreset::custom) v.section("pixel", pixel);
    v.section("readout", readout);
    v.section("background_activity_filter", background_activity_filter);
    v.section("aps", aps);
    v.section("imu", imu);
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
