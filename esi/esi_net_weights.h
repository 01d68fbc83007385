#pragma once

#include <span>

#include "esi/memory_cell.h"
#include "esi/small_convolution.h"

namespace nightjar::esi {

/// What tools/training found. Values are whole numbers: a feature or a hidden value
/// of 1 is kFeatureOne, a weight of 1 is 2^kEsiNetWeightBits in the output and 2^shift in a
/// convolution.
inline constexpr int kEsiNetWeightBits = 12;

/// The edges' three 3x3 layers, first to last. The first reads blocks of 2x2 pixels, row by
/// row, each with its kPixelFeatures.
std::span<const Convolution> esi_net_layers();

/// How often the shading's pyramid halves the resolution of the blocks, and which of its levels
/// gives the shade: level 0 has one pixel for 4x4 of the sensor's, level 1 for 8x8.
inline constexpr std::size_t kShadingLevels = 4, kShadeLevel = 1;

/// The shading's 3x3 layers: kShadingLevels on the way down, each after halve(), the first for
/// what the edges' second and third layer see; those on the way up to kShadeLevel, the coarsest
/// first, each put out by add_doubled() onto what went down; and one whose first value is the
/// shade, in deviations.
std::span<const Convolution> esi_net_shading();

/// The last layer: what the four pixels of a block are made of, kEsiNetOutputIn weights
/// each (for the hidden values, then the features), and what is added, both in units of
/// 2^-kEsiNetWeightBits.
inline constexpr int kEsiNetOutputIn = kConvolutionOut + 4 * kPixelFeatures;
std::span<const std::int16_t, 4 * kEsiNetOutputIn> esi_net_output();
std::span<const std::int32_t, 4> esi_net_output_bias();

}  // namespace nightjar::esi
