#pragma once

#include <span>

#include "esi/memory_cell.h"
#include "esi/small_convolution.h"

namespace nightjar::esi {

/// What tools/training/train.py found. Values are whole numbers: a feature or a hidden value
/// of 1 is kFeatureOne, a weight of 1 is 2^kEsiNetWeightBits.
inline constexpr int kEsiNetWeightBits = 12;

/// The 3x3 layers, first to last. The first reads blocks of 2x2 pixels, row by row, each
/// with its kPixelFeatures.
std::span<const Convolution> esi_net_layers();

/// The last layer: what the four pixels of a block are made of, kEsiNetOutputIn weights
/// each (for the hidden values, then the features), and what is added, both in units of
/// 2^-kEsiNetWeightBits.
inline constexpr int kEsiNetOutputIn = kConvolutionOut + 4 * kPixelFeatures;
std::span<const std::int16_t, 4 * kEsiNetOutputIn> esi_net_output();
std::span<const std::int32_t, 4> esi_net_output_bias();

}  // namespace nightjar::esi
