#include "camera/caer_settings.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "camera/caer_addresses.h"

namespace nightjar::camera {
namespace {

void require(bool taken, const char* name, const CaerDevice& device) {
  if (!taken)
    throw std::invalid_argument(fmt::format("DAVIS346 {}: the camera does not take source.caer.{}",
                                            device.info().serial, name));
}

std::uint32_t in_us(double time_ms) {
  return static_cast<std::uint32_t>(std::lround(time_ms * 1e3));
}

/// The camera's filters count in quarters of a millisecond.
std::uint32_t in_filter_steps(double time_ms) {
  return static_cast<std::uint32_t>(std::lround(time_ms * 4));
}

void send_host(const CaerConfig& config, CaerDevice& device) {
  require(
      device.set(caer::kHostPackets, caer::kMaxContainerInterval, in_us(config.packet_interval_ms)),
      "packet_interval_ms", device);
  require(device.set(caer::kHostDataExchange, caer::kBufferSize,
                     static_cast<std::uint32_t>(config.buffer_packets)),
          "buffer_packets", device);
  require(device.set(caer::kHostDataExchange, caer::kBlocking, 1), "blocking", device);
}

void send_biases(const BiasesConfig& biases, CaerDevice& device) {
  const auto send = [&](std::uint8_t parameter, const BiasConfig& bias, BiasKind kind) {
    require(device.set(caer::kBias, parameter, bias_bits(bias, kind)), "biases", device);
  };
  send(caer::kBiasDiff, biases.diff, BiasKind::n_type);
  send(caer::kBiasOn, biases.on, BiasKind::n_type);
  send(caer::kBiasOff, biases.off, BiasKind::n_type);
  send(caer::kBiasPr, biases.pr, BiasKind::p_type);
  send(caer::kBiasPrSf, biases.pr_sf, BiasKind::p_type);
  send(caer::kBiasRefr, biases.refr, BiasKind::p_type);
}

void send_filter(const HardwareFilterConfig& filter, CaerDevice& device) {
  const auto send = [&](std::uint8_t parameter, std::uint32_t value) {
    require(device.set(caer::kDvs, parameter, value), "hardware_filter", device);
  };
  if (device.info().has_background_activity_filter) {
    send(caer::kFilterBackgroundActivity, filter.background_activity);
    send(caer::kFilterBackgroundActivityTime, in_filter_steps(filter.background_activity_ms));
    send(caer::kFilterRefractoryPeriod, filter.refractory_period);
    send(caer::kFilterRefractoryPeriodTime, in_filter_steps(filter.refractory_period_ms));
  }
  if (device.info().has_pixel_filter) send(caer::kFilterPixelAutoTrain, filter.learn_hot_pixels);
}

void send_filter(const SoftwareFilterConfig& filter, CaerDevice& device) {
  const auto send = [&](std::uint8_t parameter, std::uint64_t value) {
    require(device.set_noise_filter(parameter, value), "software_filter", device);
  };
  send(caer::kNoiseBackgroundActivityEnable, filter.background_activity);
  send(caer::kNoiseBackgroundActivityTime, in_us(filter.background_activity_ms));
  send(caer::kNoiseRefractoryPeriodEnable, filter.refractory_period);
  send(caer::kNoiseRefractoryPeriodTime, in_us(filter.refractory_period_ms));
  send(caer::kNoiseHotPixelTime, in_us(filter.hot_pixel_learning_s * 1e3));
  send(caer::kNoiseHotPixelCount, static_cast<std::uint64_t>(filter.hot_pixel_events));
  send(caer::kNoiseHotPixelEnable, filter.learn_hot_pixels);
  send(caer::kNoiseHotPixelLearn, filter.learn_hot_pixels);
}

}  // namespace

std::uint32_t bias_bits(const BiasConfig& bias, BiasKind kind) {
  constexpr std::uint32_t kEnabled = 1, kNType = 2, kNormalType = 4, kNormalCurrent = 8;
  const std::uint32_t switches =
      kEnabled | (kind == BiasKind::n_type ? kNType : 0) | kNormalType | kNormalCurrent;
  return static_cast<std::uint32_t>(bias.coarse) << 12 |
         static_cast<std::uint32_t>(bias.fine) << 4 | switches;
}

void send_settings(const CaerConfig& config, CaerDevice& device) {
  send_host(config, device);
  send_biases(config.biases, device);
  require(device.set(caer::kAps, caer::kApsExposure, in_us(config.exposure_ms)), "exposure_ms",
          device);
  require(device.set(caer::kAps, caer::kApsFrameInterval, in_us(config.frame_interval_ms)),
          "frame_interval_ms", device);
  send_filter(config.hardware_filter, device);
  send_filter(config.software_filter, device);
}

void start_data(const CaerConfig& config, CaerDevice& device) {
  if (!device.start())
    throw std::invalid_argument(
        fmt::format("DAVIS346 {}: no data begin to flow", device.info().serial));
  if (!config.frames) require(device.set(caer::kAps, caer::kApsRun, 0), "frames", device);
  if (config.imu) return;
  for (const std::uint8_t run :
       {caer::kImuRunAccelerometer, caer::kImuRunGyroscope, caer::kImuRunTemperature})
    require(device.set(caer::kImu, run, 0), "imu", device);
}

}  // namespace nightjar::camera
