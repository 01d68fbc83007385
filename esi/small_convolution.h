#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nightjar::esi {

/// A picture of `channels` 16-bit values a pixel, channels together, with a rim of one
/// pixel around it that stays zero.
class ChannelImage {
 public:
  ChannelImage() = default;
  ChannelImage(int width, int height, int channels);

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }

  /// The values of pixel (x, y); -1 and width() or height() are on the rim.
  std::int16_t* at(int x, int y) { return values_.data() + index(x, y); }
  const std::int16_t* at(int x, int y) const { return values_.data() + index(x, y); }

 private:
  std::size_t index(int x, int y) const {
    return (static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(width_ + 2) +
            static_cast<std::size_t>(x + 1)) *
           static_cast<std::size_t>(channels_);
  }

  int width_ = 0;
  int height_ = 0;
  int channels_ = 0;
  std::vector<std::int16_t> values_;
};

/// Channels that a convolution puts out: two of the widest registers it is written for.
inline constexpr int kConvolutionOut = 16;

/// Weights of a 3x3 convolution to kConvolutionOut channels, for `in` channels, an even
/// number: [3 rows][3 columns][in / 2 pairs][kConvolutionOut][2 of a pair].
struct Convolution {
  int in = 0;
  std::span<const std::int16_t> weights;
  std::span<const std::int32_t> bias;  ///< kConvolutionOut.
  int shift = 0;                       ///< The sum's bits below a value's.
  int least = 0;                       ///< Value put out, at least; not above kMostValue.
};

/// The greatest value that convolve() puts out.
inline constexpr int kMostValue = 8191;

/// out = min(max((sum + bias + half) >> shift, least), kMostValue), zeros around the picture, in
/// whole numbers: the same on every processor. `out` has the size of `in` and
/// kConvolutionOut channels. The caller sees to it that no sum exceeds 32 bits.
void convolve(const Convolution& convolution, const ChannelImage& in, ChannelImage& out);

/// The same with instructions that a test chooses.
struct ConvolutionVariant {
  const char* name;
  void (*row)(const Convolution& convolution, const ChannelImage& in, int y, ChannelImage& out);
};

/// Those this processor runs, the plain one first and the best last.
std::vector<ConvolutionVariant> convolution_variants();

void convolve(const ConvolutionVariant& variant, const Convolution& convolution,
              const ChannelImage& in, ChannelImage& out);

}  // namespace nightjar::esi
