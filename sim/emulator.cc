#include "sim/emulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <stdexcept>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "core/random.h"
#include "sim/fired_events.h"
#include "sim/intensity.h"
#include "sim/leak.h"
#include "sim/noise.h"
#include "sim/noise_candidates.h"
#include "sim/pixel_kernel.h"
#include "sim/pixel_walks.h"

namespace nightjar::sim {
namespace {

constexpr core::Time kLongestStep = std::chrono::hours(1);

// A white pixel's k dt in one go, so that k changes little while the photoreceptor follows.
constexpr double kMostKdt = 1;
// With so many parts k hardly changes over one, however fast the photoreceptor.
constexpr int kMostParts = 32;

void check(const PixelConfig& config, core::Resolution size, double white_lux) {
  core::check_config(config, "pixel");
  if (config.log_linear_below > 0 && config.log_linear_below < std::numbers::e)
    throw std::invalid_argument(
        fmt::format("pixel.log_linear_below = {}, allowed 0, or 2.72 to 128",
                    core::number_text(config.log_linear_below)));
  core::check_range("size.width_px", size.width_px, 1, core::kMostSide_px);
  core::check_range("size.height_px", size.height_px, 1, core::kMostSide_px);
  core::check_range("white_lux", white_lux, 1e-6, 1e9);
}

/// 64 flags, each 0 or 1, as bits.
std::uint64_t bits_of(const std::uint8_t* flags) {
  std::uint64_t bits = 0;
#if defined(__SSE2__)
  for (int i = 0; i < 4; ++i) {
    __m128i sixteen;
    std::memcpy(&sixteen, flags + 16 * i, sizeof(sixteen));
    // Each byte's lowest bit goes to its top, from where they are gathered.
    const int sixteen_bits = _mm_movemask_epi8(_mm_slli_epi16(sixteen, 7));
    bits |= static_cast<std::uint64_t>(sixteen_bits) << 16 * i;
  }
#else
  static_assert(std::endian::native == std::endian::little);
  for (int i = 0; i < 8; ++i) {
    std::uint64_t eight;
    std::memcpy(&eight, flags + 8 * i, sizeof(eight));
    // The product has flag k at bit 56 + k, and nothing that carries into it.
    bits |= (eight * 0x0102040810204080u) >> 56 << 8 * i;
  }
#endif
  return bits;
}

}  // namespace

class EventEmulator::Pixels {
 public:
  Pixels(const PixelConfig& config, core::Resolution size, double white_lux, std::uint64_t seed);

  void step(core::Time t, const core::Image<float>& luminance_lux,
            std::vector<core::Event>& events);

  EmulatorCounts counts;
  std::vector<float> threshold_on, threshold_off;

 private:
  void fill_blocks(const Leak& leak, std::uint64_t seed);
  void check_step(core::Time t, const core::Image<float>& luminance_lux) const;
  void settle(const float* luminance_lux);
  int parts(core::Time dt) const;
  void advance_in_parts(core::Time t, int parts, const float* luminance_lux,
                        std::vector<core::Event>& events);
  /// To `t` at once. `dense` takes the first pixel of a block, the block and what it leaves.
  template <class Dense>
  void advance(core::Time t, Dense dense, std::vector<core::Event>& events);
  void walk_block(std::uint32_t first_pixel, PixelBlock& block);
  void mark_resting(std::uint32_t first_pixel);
  void walk_noisy(std::uint32_t first_pixel, PixelBlock& block);
  void walk_crossed(std::uint32_t first_pixel, PixelBlock& block);
  void count(BadInputs bad);
  std::uint32_t block_size(std::uint32_t first_pixel) const {
    return std::min(PixelBlock::kPixels, pixels_ - first_pixel);
  }

  PixelConfig config_;
  core::Resolution size_;
  std::uint32_t pixels_;
  KernelStep kernel_;
  std::vector<PixelBlock> blocks_;
  NoiseCandidates noise_;
  PixelWalks walks_;
  FiredEvents fired_;

  // The step under way.
  std::optional<core::Time> now_;  ///< Its begin.
  double dt_us_ = 0;
  double per_us_ = 0;  ///< 1/dt_us_
  std::span<NoiseCandidate> candidates_;
  std::size_t next_candidate_ = 0;
  std::size_t picked_noise_ = 0;        ///< So many of those before are left, at the front.
  std::vector<std::uint32_t> resting_;  ///< Pixels, ascending.
  std::size_t next_resting_ = 0;
  BlockStep block_step_;

  // Intensities of a step in parts: at its ends and at the end of a part.
  std::vector<float> from_, to_, between_;
};

EventEmulator::Pixels::Pixels(const PixelConfig& config, core::Resolution size, double white_lux,
                              std::uint64_t seed)
    : threshold_on(draw_thresholds_log(config.threshold_on_log, config.threshold_on_sigma_log,
                                       size.pixels(), core::random_stream(seed, "threshold_on"))),
      threshold_off(draw_thresholds_log(config.threshold_off_log, config.threshold_off_sigma_log,
                                        size.pixels(), core::random_stream(seed, "threshold_off"))),
      config_(config),
      size_(size),
      pixels_(static_cast<std::uint32_t>(size.pixels())),
      kernel_(kernel_step(config, white_lux)),
      blocks_((pixels_ + PixelBlock::kPixels - 1) / PixelBlock::kPixels),
      noise_(config, threshold_on, threshold_off, seed),
      walks_(config, pixels_, Leak(config, threshold_on, seed)) {
  fill_blocks(walks_.leak(), seed);
}

void EventEmulator::Pixels::fill_blocks(const Leak& leak, std::uint64_t seed) {
  const std::vector<float> phases = draw_leak_phases_log(threshold_on, seed);
  for (std::uint32_t p = 0; p < pixels_; ++p) {
    PixelBlock& block = blocks_[p / PixelBlock::kPixels];
    const std::uint32_t i = p % PixelBlock::kPixels;
    block.threshold_on[i] = threshold_on[p];
    block.threshold_off[i] = threshold_off[p];
    block.leak_per_s[i] = leak.enabled() ? leak.mean_per_s(p) : 0.0f;
    block.residual[i] = leak.enabled() ? phases[p] : 0.0f;
  }
}

void EventEmulator::Pixels::check_step(core::Time t,
                                       const core::Image<float>& luminance_lux) const {
  if (luminance_lux.size() != size_)
    throw std::invalid_argument(fmt::format("luminance of {}x{} px, expected {}x{}",
                                            luminance_lux.width(), luminance_lux.height(),
                                            size_.width_px, size_.height_px));
  if (now_ && (t <= *now_ || t - *now_ > kLongestStep))
    throw std::invalid_argument(fmt::format(
        "time = {} us, allowed above {} and at most an hour later", t.count(), now_->count()));
}

void EventEmulator::Pixels::step(core::Time t, const core::Image<float>& luminance_lux,
                                 std::vector<core::Event>& events) {
  check_step(t, luminance_lux);
  const float* luminance = luminance_lux.pixels().data();
  if (!now_) {
    settle(luminance);
    noise_.start(t);
    now_ = t;
  } else if (const int n = parts(t - *now_); n > 1) {
    advance_in_parts(t, n, luminance, events);
  } else {
    const auto dense = [&](std::uint32_t first, PixelBlock& block) {
      count(advance_pixels(kernel_, luminance + first, block_size(first), block, block_step_));
    };
    advance(t, dense, events);
  }
}

/// Never more than there are microseconds, since the cutoff is at most 1e5 Hz.
int EventEmulator::Pixels::parts(core::Time dt) const {
  const double white_kdt = rate_per_intensity(config_) * kWhiteWithOffset * core::seconds(dt);
  return static_cast<int>(std::clamp(std::ceil(white_kdt / kMostKdt), 1.0, 1.0 * kMostParts));
}

void EventEmulator::Pixels::advance_in_parts(core::Time t, int parts, const float* luminance_lux,
                                             std::vector<core::Event>& events) {
  for (std::vector<float>* room : {&from_, &to_, &between_}) room->resize(pixels_);
  for (std::uint32_t first = 0; first < pixels_; first += PixelBlock::kPixels) {
    const PixelBlock& block = blocks_[first / PixelBlock::kPixels];
    std::copy_n(block.intensity, block_size(first), &from_[first]);
    count(clean_intensities(kernel_, luminance_lux + first, block_size(first), block, &to_[first]));
  }
  const core::Time begin = *now_, dt = t - begin;
  for (int part = 1; part <= parts; ++part) {
    const core::Time end = begin + dt * part / parts;
    if (end < t)
      intensities_between(kernel_, from_.data(), to_.data(),
                          static_cast<float>(core::seconds(end - begin) / core::seconds(dt)),
                          pixels_, between_.data());
    const float* intensity = end < t ? between_.data() : to_.data();
    const auto dense = [&](std::uint32_t first, PixelBlock& block) {
      advance_clean_pixels(kernel_, intensity + first, block_size(first), block, block_step_);
    };
    advance(end, dense, events);
  }
}

void EventEmulator::Pixels::settle(const float* luminance_lux) {
  for (std::uint32_t first = 0; first < pixels_; first += PixelBlock::kPixels)
    count(settle_pixels(kernel_, luminance_lux + first, block_size(first),
                        blocks_[first / PixelBlock::kPixels]));
}

template <class Dense>
void EventEmulator::Pixels::advance(core::Time t, Dense dense, std::vector<core::Event>& events) {
  const core::Time begin = *now_, dt = t - begin;
  dt_us_ = static_cast<double>(dt.count());
  per_us_ = 1 / dt_us_;
  set_step(kernel_, config_, dt_us_ * 1e-6);
  walks_.begin_step(begin, dt);
  candidates_ = noise_.draw(t);
  next_candidate_ = picked_noise_ = next_resting_ = 0;
  for (std::uint32_t first = 0; first < pixels_; first += PixelBlock::kPixels) {
    PixelBlock& block = blocks_[first / PixelBlock::kPixels];
    dense(first, block);
    walk_block(first, block);
  }
  walks_.run(fired_, counts);
  resting_ = walks_.take_resting();
  fired_.hand_over(begin, dt, size_.width_px, events);
  now_ = t;
}

void EventEmulator::Pixels::walk_block(std::uint32_t first_pixel, PixelBlock& block) {
  walks_.make_room(PixelBlock::kPixels, fired_, counts);
  mark_resting(first_pixel);
  walk_noisy(first_pixel, block);
  walk_crossed(first_pixel, block);
}

void EventEmulator::Pixels::mark_resting(std::uint32_t first_pixel) {
  for (; next_resting_ < resting_.size(); ++next_resting_) {
    const std::uint32_t i = resting_[next_resting_] - first_pixel;
    if (i >= PixelBlock::kPixels) break;
    block_step_.crossed[i] = 1;
  }
}

/// Thins the block's candidates by v2e's law; they take their pixels' marks with them.
void EventEmulator::Pixels::walk_noisy(std::uint32_t first_pixel, PixelBlock& block) {
  const std::size_t first_noise = picked_noise_;
  for (; next_candidate_ < candidates_.size(); ++next_candidate_) {
    NoiseCandidate& candidate = candidates_[next_candidate_];
    const std::uint32_t i = candidate.pixel - first_pixel;
    if (i >= PixelBlock::kPixels) break;
    const double before = block_step_.intensity[i];
    const double s = (candidate.t_us - static_cast<double>(now_->count())) * per_us_;
    const double intensity = before + (block.intensity[i] - before) * s;
    // No branch, since nobody can guess which are taken.
    candidates_[picked_noise_] = candidate;
    picked_noise_ += static_cast<std::size_t>((candidate.kind == NoiseCandidate::hot) |
                                              (candidate.mark < shot_noise_factor(intensity)));
  }
  const std::span<const NoiseCandidate> picked = candidates_.first(picked_noise_);
  for (std::size_t begin = first_noise, end = begin; begin < picked.size(); begin = end) {
    const std::uint32_t i = picked[begin].pixel - first_pixel;
    while (end < picked.size() && picked[end].pixel == picked[begin].pixel) ++end;
    walks_.add(first_pixel, i, block, block_step_, picked.subspan(begin, end - begin));
    block_step_.crossed[i] = 0;
  }
}

void EventEmulator::Pixels::walk_crossed(std::uint32_t first_pixel, PixelBlock& block) {
  std::array<std::uint32_t, PixelBlock::kPixels> crossed;
  std::uint32_t count = 0;
  for (std::uint32_t begin = 0; begin < PixelBlock::kPixels; begin += 64)
    for (std::uint64_t bits = bits_of(block_step_.crossed + begin); bits != 0; bits &= bits - 1)
      crossed[count++] = begin + static_cast<std::uint32_t>(std::countr_zero(bits));
  for (std::uint32_t k = 0; k < count; ++k)
    walks_.add(first_pixel, crossed[k], block, block_step_, {});
}

void EventEmulator::Pixels::count(BadInputs bad) {
  counts.negative_radiance += bad.negative;
  counts.not_finite_radiance += bad.not_finite;
}

EventEmulator::EventEmulator(const PixelConfig& config, core::Resolution size, double white_lux,
                             std::uint64_t seed) {
  check(config, size, white_lux);
  pixels_ = std::make_unique<Pixels>(config, size, white_lux, seed);
}

EventEmulator::~EventEmulator() = default;
EventEmulator::EventEmulator(EventEmulator&&) noexcept = default;
EventEmulator& EventEmulator::operator=(EventEmulator&&) noexcept = default;

void EventEmulator::step(core::Time t, const core::Image<float>& luminance_lux,
                         std::vector<core::Event>& events) {
  pixels_->step(t, luminance_lux, events);
}

const EmulatorCounts& EventEmulator::counts() const { return pixels_->counts; }

std::span<const float> EventEmulator::thresholds_on_log() const { return pixels_->threshold_on; }

std::span<const float> EventEmulator::thresholds_off_log() const { return pixels_->threshold_off; }

}  // namespace nightjar::sim
