#pragma once

#include <cstdint>

#include "camera/caer_config.h"
#include "camera/caer_device.h"

namespace nightjar::camera {

/// How a DAVIS346 takes a bias current: which kind of transistor it feeds is part of it.
enum class BiasKind { n_type, p_type };

/// The chip's number for a bias: 3 bits coarse, 8 bits fine, 4 bits of switches, as
/// libcaer's caerBiasCoarseFineGenerate() makes them.
std::uint32_t bias_bits(const BiasConfig& bias, BiasKind kind);

/// Sends what must be there before the data begin: host buffers, biases, exposure, filters
/// (those of the hardware only where the camera has them). Throws std::invalid_argument
/// naming the parameter that the camera refuses.
void send_settings(const CaerConfig& config, CaerDevice& device);

/// Starts the data, and turns off again what `config` does not want. Throws as above.
void start_data(const CaerConfig& config, CaerDevice& device);

}  // namespace nightjar::camera
