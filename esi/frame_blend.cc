#include "esi/frame_blend.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "esi/best_instructions.h"
#include "esi/fast_math.h"
#include "esi/packed_event.h"
#include "esi/reconstructor.h"

namespace nightjar::esi {
namespace {

constexpr double kShareOfSigma = 0.75;
constexpr double kLeastContrast = 0.15;
constexpr double kMostNoise = 0.2;
constexpr float kHalfShare = 0.25f;
constexpr float kContrastLog = 0.15f;

// Of MemoryCell::sum: the balance of ON and OFF of late, and what is above 0 from a pixel's first
// event on.
constexpr std::size_t kBalance = 3, kActivity = 6;
static_assert(kPixelMemories[kBalance].moving && !kPixelMemories[kBalance].activity);
static_assert(kPixelMemories[kBalance].rate_hz == 15.0f);
static_assert(kPixelMemories[kActivity].moving && kPixelMemories[kActivity].activity);

/// Of `size` pixels in line.
int within_reach(int at, int size) {
  return std::min(at + FrameBlend::kReach_px, size - 1) - std::max(at - FrameBlend::kReach_px, 0) +
         1;
}

/// The sum of term(i) for i below `count`, each below 2^21: exact, in whatever order.
template <class Term>
std::uint64_t sum_of(std::size_t count, const Term& term) {
  constexpr std::size_t kPiece = 2048;  // whose sum keeps to 32 bits
  std::uint64_t sum = 0;
  for (std::size_t from = 0; from < count; from += kPiece) {
    const std::size_t end = std::min(from + kPiece, count);
    std::uint32_t of_piece = 0;
    std::uint32_t* const out = &of_piece;
    with_best_instructions([=]() __attribute__((always_inline)) {
      std::uint32_t terms = 0;
      for (std::size_t i = from; i < end; ++i) terms += static_cast<std::uint32_t>(term(i));
      *out = terms;
    });
    sum += of_piece;
  }
  return sum;
}

std::uint64_t squared_differences(const std::uint16_t* a, const std::uint16_t* b,
                                  std::size_t count) {
  const auto square = [=](std::size_t i) __attribute__((always_inline)) {
    const int difference = a[i] - b[i];
    return difference * difference;
  };
  return sum_of(count, square);
}

struct Moments {
  double mean;
  double variance;
};

Moments moments(const core::Image<std::uint16_t>& image) {
  const std::uint16_t* values = image.pixels().data();
  const std::size_t pixels = image.pixels().size();
  const auto value = [=](std::size_t i) __attribute__((always_inline)) { return values[i]; };
  const auto square = [=](std::size_t i) __attribute__((always_inline)) {
    return values[i] * values[i];
  };
  const auto count = static_cast<double>(pixels);
  const double mean = static_cast<double>(sum_of(pixels, value)) / count;
  const double mean_square = static_cast<double>(sum_of(pixels, square)) / count;
  return {mean, std::max(mean_square - mean * mean, 0.0)};
}

/// Half the mean square of the difference between pixels side by side, or one above the other.
double noise_variance(const core::Image<std::uint16_t>& image) {
  const auto width = static_cast<std::size_t>(image.width());
  const std::size_t pixels = image.pixels().size();
  const std::uint16_t* value = image.pixels().data();
  std::uint64_t squares = squared_differences(value + width, value, pixels - width);
  for (std::size_t row = 0; row < pixels; row += width)
    squares += squared_differences(value + row + 1, value + row, width - 1);
  const std::size_t pairs = 2 * pixels - width - pixels / width;
  return static_cast<double>(squares) / static_cast<double>(2 * std::max<std::size_t>(pairs, 1));
}

}  // namespace

FrameBlend::FrameBlend(core::Resolution size, double levels_per_sigma)
    : levels_per_sigma_(levels_per_sigma),
      gain_log2_(size),
      busy_(size),
      columns_(static_cast<std::size_t>(size.width_px + 2 * kReach_px)),
      nearby_(static_cast<std::size_t>(size.width_px)),
      share_(size) {
  for (int x = 0; x < size.width_px; ++x)
    per_column_.push_back(1.0f / static_cast<float>(within_reach(x, size.width_px)));
}

void FrameBlend::take(core::ApsFrame frame) {
  frame_ = std::move(frame);
  has_frame_ = true;
  levels_.reset();
}

FrameBlend::Levels FrameBlend::find_levels() const {
  const auto [mean, variance] = moments(frame_.gray);
  if (!(noise_variance(frame_.gray) < kMostNoise * variance)) return {0, 0};
  const double sigma = std::max(std::sqrt(variance), kLeastContrast * mean);
  const double gain = kShareOfSigma * levels_per_sigma_ / sigma;
  return {static_cast<float>(gain), static_cast<float>(gain * mean)};
}

void FrameBlend::look_at(std::span<const MemoryCell> cells, core::Time t) {
  const std::uint32_t now_us = low_us(t);
  const std::uint32_t open_us = low_us(std::max(t - frame_.exposure_begin, core::Time{}));
  const MemoryCell* cell = cells.data();
  float* gain_log2 = gain_log2_.pixels().data();
  std::uint8_t* busy = busy_.pixels().data();
  const std::size_t count = cells.size();
  with_best_instructions([=]() __attribute__((always_inline)) {
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t age_us = now_us - cell[i].t_us;
      const bool is_busy = (cell[i].sum[kActivity] > 0.0f) & (age_us <= open_us);
      const float left = 1.0f - kPixelMemories[kBalance].rate_hz * 1e-6f * to_float(age_us);
      const float balance = cell[i].sum[kBalance] * select(left > 0.0f, left, 0.0f);
      gain_log2[i] = select(is_busy, kContrastLog * kLog2E * balance, 0.0f);
      busy[i] = is_busy;
    }
  });
}

void FrameBlend::add_to_columns(int row, std::int16_t times) {
  if (row < 0 || row >= busy_.height()) return;
  const std::uint8_t* busy = &busy_(0, row);
  std::int16_t* column = &columns_[kReach_px];
  for (int x = 0; x < busy_.width(); ++x)
    column[x] = static_cast<std::int16_t>(column[x] + times * busy[x]);
}

void FrameBlend::count_nearby() {
  const std::int16_t* column = columns_.data();
  std::int16_t* nearby = nearby_.data();
  const std::size_t width = nearby_.size();
  std::ranges::fill(nearby_, std::int16_t{0});
  with_best_instructions([=]() __attribute__((always_inline)) {
    for (std::size_t k = 0; k <= 2 * kReach_px; ++k)
      for (std::size_t x = 0; x < width; ++x)
        nearby[x] = static_cast<std::int16_t>(nearby[x] + column[x + k]);
  });
}

void FrameBlend::find_shares() {
  const int width = busy_.width(), height = busy_.height();
  std::ranges::fill(columns_, std::int16_t{0});
  for (int row = 0; row < kReach_px; ++row) add_to_columns(row, 1);
  for (int y = 0; y < height; ++y) {
    add_to_columns(y + kReach_px, 1);
    add_to_columns(y - kReach_px - 1, -1);
    count_nearby();
    const float per_row = 1.0f / static_cast<float>(within_reach(y, height));
    const float* per_column = per_column_.data();
    const std::int16_t* nearby = nearby_.data();
    float* share = &share_(0, y);
    with_best_instructions([=]() __attribute__((always_inline)) {
#pragma GCC ivdep
      for (int x = 0; x < width; ++x)
        share[x] = static_cast<float>(nearby[x]) * per_row * per_column[x];
    });
  }
}

/// All pixels in one loop: of a row's, many would be left over beside whole registers.
void FrameBlend::blend_pixels(Levels levels, core::Image<std::uint8_t>& gray) const {
  const float* shares = share_.pixels().data();
  const float* gain_log2 = gain_log2_.pixels().data();
  const std::uint16_t* value = frame_.gray.pixels().data();
  std::uint8_t* out = gray.pixels().data();
  const std::size_t count = gray.pixels().size();
  with_best_instructions([=]() __attribute__((always_inline)) {
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) {
      const float share = shares[i];
      const float in_halves = share * (1.0f / kHalfShare);
      const float weight = (1.0f - share * share) / (1.0f + in_halves * in_halves);
      const float brightness = static_cast<float>(value[i]) * fast_exp2(gain_log2[i]);
      const float shown = 127.5f + (levels.gain * brightness - levels.offset);
      const auto events = static_cast<float>(out[i]);
      out[i] = to_gray(events + weight * (bounded(shown, 0.0f, 255.0f) - events));
    }
  });
}

void FrameBlend::blend(std::span<const MemoryCell> cells, core::Time t,
                       core::Image<std::uint8_t>& gray) {
  constexpr core::Time kOldest{Reconstructor::kMostAge_us};
  if (!has_frame_ || t - frame_.exposure_begin > kOldest) return;
  if (!levels_) levels_ = find_levels();
  if (levels_->gain == 0) return;
  look_at(cells, t);
  find_shares();
  blend_pixels(*levels_, gray);
}

}  // namespace nightjar::esi
