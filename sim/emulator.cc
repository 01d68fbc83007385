#include "sim/emulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/random.h"
#include "sim/noise.h"
#include "sim/pixel.h"
#include "sim/pixel_kernel.h"
#include "sim/radix_sort.h"

namespace nightjar::sim {
namespace {

constexpr std::uint32_t kBlock = 1024;  // so that one block's arrays stay in the cache
constexpr int kMostSidePx = 32767;
constexpr core::Time kLongestStep = std::chrono::hours(1);

std::uint32_t bits_for(std::uint64_t below) {
  return static_cast<std::uint32_t>(std::bit_width(below - 1));
}

void check(const PixelConfig& config, core::Resolution size, double white_lux) {
  core::check_config(config, "pixel");
  if (config.log_linear_below > 0 && config.log_linear_below < std::numbers::e)
    throw std::invalid_argument(
        fmt::format("pixel.log_linear_below = {}, allowed 0, or 2.72 to 128",
                    core::number_text(config.log_linear_below)));
  core::check_range("size.width_px", size.width_px, 1, kMostSidePx);
  core::check_range("size.height_px", size.height_px, 1, kMostSidePx);
  core::check_range("white_lux", white_lux, 1e-6, 1e9);
}

/// What scratch a block needs: the state before the step and what crossed.
struct BlockScratch {
  float intensity[kBlock];
  float log_intensity[kBlock];
  float lag[kBlock] = {};
  float residual[kBlock];
  std::uint32_t crossed[kBlock];
};

/// A noise event that a pixel may fire in the step under way.
struct Candidate {
  std::uint32_t pixel;
  enum Kind : std::uint32_t { shot_off, shot_on, hot } kind;
  double s;    ///< Time in the step, 0 at its begin, 1 at its end.
  float mark;  ///< For thinning.
};

/// An event before it is put in order.
struct Fired {
  std::uint32_t offset_us;  ///< After the begin of the step.
  std::uint32_t pixel : 31;
  std::uint32_t on : 1;
};

}  // namespace

class EventEmulator::Pixels {
 public:
  Pixels(const PixelConfig& config, core::Resolution size, double white_lux, std::uint64_t seed);

  void step(core::Time t, const core::Image<float>& luminance_lux,
            std::vector<core::Event>& events);

  EmulatorCounts counts;
  std::vector<float> threshold_on, threshold_off;

 private:
  void check_step(core::Time t, const core::Image<float>& luminance_lux) const;
  void settle(const float* luminance_lux);
  void draw_candidates(core::Time t);
  void draw_candidates(PointProcess& process, core::Time t, Candidate::Kind kind);
  void advance_block(std::uint32_t begin, std::uint32_t count, const float* luminance_lux);
  KernelBlock block_of(std::uint32_t begin, const float* luminance_lux);
  /// Thins the block's candidates; marks the pixels that need more than the dense pass.
  void mark_special(std::uint32_t begin, std::uint32_t end);
  void walk(std::uint32_t p, std::uint32_t in_block);
  double fire_crossings(std::uint32_t p, ResidualCourse& course, double from, double to);
  double fire(std::uint32_t p, ResidualCourse& course, double s, double level, bool on);
  bool takes_place(const Candidate& candidate, std::uint32_t in_block) const;
  void hand_over(std::vector<core::Event>& events);

  PixelConfig config_;
  core::Resolution size_;
  std::uint32_t pixels_;
  KernelStep kernel_;
  double rate_per_intensity_;

  // State and constants of each pixel.
  std::vector<float> intensity_, log_intensity_, lag_, residual_;
  std::vector<float> leak_per_s_, leak_mean_per_s_;
  std::vector<std::uint32_t> leak_draws_;
  std::vector<double> rest_until_us_;

  std::uint64_t leak_key_;
  PointProcess shot_on_, shot_off_, hot_;
  HotPixels hot_pixels_;

  // The step under way.
  std::optional<core::Time> now_;  ///< Its begin.
  double dt_us_ = 0;
  std::vector<Candidate> candidates_, candidates_scratch_;  ///< By pixel, then time.
  std::size_t next_candidate_ = 0;
  std::vector<Candidate> noise_;  ///< Those of the block under way that take place.
  std::size_t next_noise_ = 0;
  std::vector<std::uint32_t> resting_, resting_next_;  ///< Pixels, ascending.
  std::size_t next_resting_ = 0;
  std::vector<Fired> fired_, fired_scratch_;
  std::vector<NoisePoint> points_;
  BlockScratch before_;
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
      rate_per_intensity_(rate_per_intensity(config)),
      intensity_(pixels_),
      log_intensity_(pixels_),
      lag_(pixels_),
      residual_(pixels_),
      leak_per_s_(pixels_),
      leak_mean_per_s_(pixels_),
      leak_draws_(config.leak_rate_hz > 0 ? pixels_ : 0),
      rest_until_us_(config.refractory_us > 0 ? pixels_ : 0, -1e300),
      leak_key_(core::random_stream(seed, "leak_jitter")()),
      shot_on_(
          shot_noise_rates_hz(config.shot_noise_rate_hz, config.threshold_on_log, threshold_on),
          core::random_stream(seed, "shot_on")),
      shot_off_(
          shot_noise_rates_hz(config.shot_noise_rate_hz, config.threshold_off_log, threshold_off),
          core::random_stream(seed, "shot_off")),
      hot_({}, core::Random()),
      hot_pixels_(draw_hot_pixels(config, pixels_, seed)) {
  hot_ = PointProcess(hot_pixels_.rates_hz, core::random_stream(seed, "hot_pixel_time"));
  if (config.leak_rate_hz <= 0) return;
  core::Random spread = core::random_stream(seed, "leak_spread");
  core::Random phase = core::random_stream(seed, "leak_phase");
  for (std::uint32_t p = 0; p < pixels_; ++p) {
    const double rate_hz =
        config.leak_rate_hz * std::pow(10.0, config.leak_spread_decades * core::normal(spread));
    leak_mean_per_s_[p] = static_cast<float>(rate_hz * threshold_on[p]);
    leak_per_s_[p] = leak_mean_per_s_[p];
    // Each pixel starts somewhere between two leak events; else all fire at once.
    residual_[p] = static_cast<float>(core::uniform01(phase) * threshold_on[p]);
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
    for (PointProcess* process : {&shot_on_, &shot_off_, &hot_}) process->start(t);
    now_ = t;
    return;
  }
  dt_us_ = static_cast<double>((t - *now_).count());
  set_step(kernel_, config_, dt_us_ * 1e-6);
  draw_candidates(t);
  for (std::uint32_t begin = 0; begin < pixels_; begin += kBlock)
    advance_block(begin, std::min(kBlock, pixels_ - begin), luminance);
  resting_.swap(resting_next_);
  resting_next_.clear();
  next_resting_ = 0;
  hand_over(events);
  now_ = t;
}

KernelBlock EventEmulator::Pixels::block_of(std::uint32_t begin, const float* luminance_lux) {
  return {luminance_lux + begin,
          intensity_.data() + begin,
          log_intensity_.data() + begin,
          lag_.data() + begin,
          residual_.data() + begin,
          threshold_on.data() + begin,
          threshold_off.data() + begin,
          leak_per_s_.data() + begin,
          before_.intensity,
          before_.log_intensity,
          before_.lag,
          before_.residual,
          before_.crossed};
}

void EventEmulator::Pixels::settle(const float* luminance_lux) {
  counts.bad_radiance += settle_pixels(kernel_, block_of(0, luminance_lux), pixels_);
}

void EventEmulator::Pixels::draw_candidates(core::Time t) {
  candidates_.clear();
  next_candidate_ = 0;
  draw_candidates(shot_on_, t, Candidate::shot_on);
  draw_candidates(shot_off_, t, Candidate::shot_off);
  draw_candidates(hot_, t, Candidate::hot);
  const auto by_pixel = [](const Candidate& c) { return c.pixel; };
  radix_sort(candidates_, candidates_scratch_, static_cast<int>(bits_for(pixels_)), by_pixel);
  // Within a pixel there are three processes, each in order of time.
  const auto later = [](const Candidate& a, const Candidate& b) {
    return a.pixel == b.pixel && a.s > b.s;
  };
  for (std::size_t i = 1; i < candidates_.size(); ++i)
    for (std::size_t k = i; k > 0 && later(candidates_[k - 1], candidates_[k]); --k)
      std::swap(candidates_[k - 1], candidates_[k]);
}

void EventEmulator::Pixels::draw_candidates(PointProcess& process, core::Time t,
                                            Candidate::Kind kind) {
  points_.clear();
  process.draw(t, points_);
  for (const NoisePoint& point : points_) {
    const std::uint32_t pixel =
        kind == Candidate::hot ? hot_pixels_.pixels[point.source] : point.source;
    const double s = (point.t_us - static_cast<double>(now_->count())) / dt_us_;
    candidates_.push_back({pixel, kind, s, point.mark});
  }
}

void EventEmulator::Pixels::advance_block(std::uint32_t begin, std::uint32_t count,
                                          const float* luminance_lux) {
  counts.bad_radiance += advance_pixels(kernel_, block_of(begin, luminance_lux), count);
  mark_special(begin, begin + count);
  constexpr std::uint32_t kGroup = 16;
  for (std::uint32_t first = 0; first < count; first += kGroup) {
    const std::uint32_t last = std::min(first + kGroup, count);
    std::uint32_t any = 0;
    for (std::uint32_t i = first; i < last; ++i) any |= before_.crossed[i];
    if (!any) continue;
    for (std::uint32_t i = first; i < last; ++i)
      if (before_.crossed[i]) walk(begin + i, i);
  }
}

void EventEmulator::Pixels::mark_special(std::uint32_t begin, std::uint32_t end) {
  noise_.clear();
  next_noise_ = 0;
  for (; next_candidate_ < candidates_.size(); ++next_candidate_) {
    const Candidate& candidate = candidates_[next_candidate_];
    if (candidate.pixel >= end) break;
    if (!takes_place(candidate, candidate.pixel - begin)) continue;
    noise_.push_back(candidate);
    before_.crossed[candidate.pixel - begin] = 1;
  }
  for (; next_resting_ < resting_.size() && resting_[next_resting_] < end; ++next_resting_)
    before_.crossed[resting_[next_resting_] - begin] = 1;
}

bool EventEmulator::Pixels::takes_place(const Candidate& candidate, std::uint32_t in_block) const {
  if (candidate.kind == Candidate::hot) return true;
  const double from = before_.intensity[in_block];
  const double intensity = from + (intensity_[candidate.pixel] - from) * candidate.s;
  return candidate.mark < shot_noise_factor(intensity);
}

/// Takes one pixel through the step event by event.
void EventEmulator::Pixels::walk(std::uint32_t p, std::uint32_t in_block) {
  const double intensity_0 = before_.intensity[in_block];
  const double intensity_1 = intensity_[p];
  const double change = static_cast<double>(log_intensity_[p]) - before_.log_intensity[in_block];
  const double rate =
      rate_per_intensity_ * (0.5 * (intensity_0 + intensity_1) + 20) * dt_us_ * 1e-6;
  ResidualCourse course(change, leak_per_s_[p] * dt_us_ * 1e-6, before_.lag[in_block],
                        before_.residual[in_block], rate);
  double awake = 0;  // the pixel can fire from here on
  if (!rest_until_us_.empty()) {
    awake = std::max(0.0, (rest_until_us_[p] - static_cast<double>(now_->count())) / dt_us_);
    if (awake > 0 && awake <= 1) course.memorise(course.residual(awake));
  }
  for (; next_noise_ < noise_.size() && noise_[next_noise_].pixel == p; ++next_noise_) {
    const Candidate& noise = noise_[next_noise_];
    awake = fire_crossings(p, course, awake, noise.s);
    if (awake > noise.s) continue;
    ++(noise.kind == Candidate::hot ? counts.hot : counts.shot);
    awake = fire(p, course, noise.s, course.residual(noise.s), noise.kind != Candidate::shot_off);
  }
  awake = fire_crossings(p, course, awake, 1);
  if (awake > 1) resting_next_.push_back(p);
  residual_[p] = awake > 1 ? 0.0f : static_cast<float>(course.residual(1));
}

/// Fires what the signal and the leak give in [from, to]; returns from when on the
/// pixel is awake, at least `to`.
double EventEmulator::Pixels::fire_crossings(std::uint32_t p, ResidualCourse& course, double from,
                                             double to) {
  while (from < to) {
    const double residual = course.residual(to);
    const bool on = residual >= threshold_on[p];
    if (!on && residual > -threshold_off[p]) return to;
    const double level = on ? threshold_on[p] : -threshold_off[p];
    constexpr double kToleranceUs = 0.05;
    ++counts.signal;
    const double s = course.crossing(from, to, level, kToleranceUs / dt_us_);
    from = fire(p, course, s, level, on);
  }
  return from;
}

/// One event at `s`, with the residual at `level`; returns when the pixel is awake again.
double EventEmulator::Pixels::fire(std::uint32_t p, ResidualCourse& course, double s, double level,
                                   bool on) {
  // The first whole microsecond not before it, so that it lies in (begin, end].
  const double offset_us = std::clamp(std::ceil(s * dt_us_), 1.0, dt_us_);
  fired_.push_back({static_cast<std::uint32_t>(offset_us), p & 0x7fffffffu, on});
  course.memorise(level);
  if (!leak_draws_.empty()) {
    // v2e draws the jitter for each frame, which the number of frames averages out;
    // here each interval between events has one draw.
    const double deviation = leak_deviation(leak_key_, p, leak_draws_[p]++);
    leak_per_s_[p] =
        static_cast<float>(leak_mean_per_s_[p] / (1 + config_.leak_jitter * deviation));
    course.change_leak(s, leak_per_s_[p] * dt_us_ * 1e-6);
  }
  if (rest_until_us_.empty()) return s;
  const double awake = s + config_.refractory_us / dt_us_;
  rest_until_us_[p] = static_cast<double>(now_->count()) + awake * dt_us_;
  // Held in reset, it memorises what it wakes up to.
  if (awake <= 1) course.memorise(course.residual(awake));
  return awake;
}

void EventEmulator::Pixels::hand_over(std::vector<core::Event>& events) {
  // They come by pixel, and each pixel's in order.
  const auto bits = bits_for(static_cast<std::uint64_t>(dt_us_) + 1);
  radix_sort(fired_, fired_scratch_, static_cast<int>(bits),
             [](const Fired& f) { return f.offset_us; });
  const auto width = static_cast<std::uint32_t>(size_.width_px);
  for (const Fired& f : fired_)
    events.push_back({*now_ + core::Time(f.offset_us), static_cast<std::uint16_t>(f.pixel % width),
                      static_cast<std::uint16_t>(f.pixel / width), f.on != 0});
  fired_.clear();
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
