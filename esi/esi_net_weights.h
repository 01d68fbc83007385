#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "esi/memory_cell.h"
#include "esi/small_convolution.h"

namespace nightjar::esi {

/// What tools/training found. Values are whole numbers: a feature or a hidden value
/// of 1 is kFeatureOne, a weight of 1 is 2^kEsiNetWeightBits in the output and 2^shift in a
/// convolution.
inline constexpr int kEsiNetWeightBits = 12;

inline constexpr std::size_t kEdgeLayers = 3, kPixelsABlock = 4;
inline constexpr std::size_t kEsiNetOutputIn = kConvolutionOut + kPixelsABlock * kPixelFeatures;

/// What finds the edges.
struct EdgeWeights {
  /// 3x3, first to last. The first reads blocks of 2x2 pixels, row by row, each with its
  /// kPixelFeatures.
  std::array<Convolution, kEdgeLayers> layers;
  /// The last layer: what the four pixels of a block are made of, kEsiNetOutputIn weights each (for
  /// the hidden values, then the features), and what is added, both in units of
  /// 2^-kEsiNetWeightBits.
  std::span<const std::int16_t, kPixelsABlock * kEsiNetOutputIn> output;
  std::span<const std::int32_t, kPixelsABlock> output_bias;
};

/// Two sets that EdgeMixture mixes; a layer has the same shift in both.
const std::array<EdgeWeights, 2>& esi_net_edges();

/// By what second_share() tells them apart: a weight for each of a pixel's features, then the bias,
/// in units of 2^-kEsiNetWeightBits.
std::span<const std::int32_t, kPixelFeatures + 1> esi_net_gate();

/// How often the shading's pyramid halves the resolution of the blocks, and which of its levels
/// gives the shade: level 0 has one pixel for 4x4 of the sensor's, level 1 for 8x8.
inline constexpr std::size_t kShadingLevels = 4, kShadeLevel = 1;

/// The shading's 3x3 layers: kShadingLevels on the way down, each after halve(), the first for
/// what the edges' second and third layer see; those on the way up to kShadeLevel, the coarsest
/// first, each put out by add_doubled() onto what went down; and one whose first value is the
/// shade, in deviations.
std::span<const Convolution> esi_net_shading();

}  // namespace nightjar::esi
