#include "esi/fedi.h"

#include "esi/fast_math.h"

namespace nightjar::esi {

Fedi::Fedi(const DoubleIntegralConfig& config, core::Resolution size)
    : DoubleIntegral(config, size, "fedi"),
      cursors_(static_cast<std::size_t>(size.pixels())),
      runs_(cursors_.size() + 1),
      first_run_(static_cast<std::size_t>(size.height_px) + 1) {
  reset();
}

/// Sets cursors_, runs_ and first_run_: a pixel with n events stays n + 1 times.
void Fedi::make_room(const Exposure& exposure) {
  cursors_.assign(cursors_.size(), Cursor{0, exposure.begin_us, 0});
  for (const PackedEvent& e : exposure.events) ++cursors_[e.pixel()].next;
  const auto width = static_cast<std::uint32_t>(size().width_px);
  std::uint32_t runs = 0, begin = 0, pixel = 0;
  for (std::size_t y = 0; y + 1 < first_run_.size(); ++y) {
    first_run_[y] = runs;
    for (std::uint32_t x = 0; x < width; ++x, ++pixel) {  // without a branch to mispredict
      const std::uint32_t events = cursors_[pixel].next;
      const std::uint32_t is_run = events != 0;
      runs_[runs] = {pixel, begin};
      cursors_[pixel].next = begin;
      runs += is_run;
      begin += events + is_run;
    }
  }
  first_run_.back() = runs;
  runs_[runs] = {0, begin};
  if (stays_.size() < begin) stays_.resize(begin);
}

void Fedi::expose(const Exposure& exposure) {
  make_room(exposure);
  for (const PackedEvent& e : exposure.events) {
    Cursor& cursor = cursors_[e.pixel()];
    stays_[cursor.next++] = {e.t_us - cursor.t_us, Growth::level(cursor.level)};
    cursor.t_us = e.t_us;
    cursor.level += e.on() ? 1 : -1;
  }
  for (std::size_t i = 0; i < first_run_.back(); ++i) {
    const Cursor& cursor = cursors_[runs_[i].pixel];
    stays_[cursor.next] = {exposure.end_us - cursor.t_us, Growth::level(cursor.level)};
  }
  duration_us_ = exposure.end_us - exposure.begin_us;
}

void Fedi::log_means(const Growth& growth, SharpnessRows rows, core::Image<float>& log2) {
  float* out = log2.pixels().data();
  for (int y = 0; y < size().height_px; ++y) {
    if (!rows.takes(y)) continue;
    const Run* run = runs_.data() + first_run_[static_cast<std::size_t>(y)];
    const Run* end = runs_.data() + first_run_[static_cast<std::size_t>(y) + 1];
    for (; run != end; ++run) {
      double integral_us = 0;
      for (std::uint32_t i = run->begin; i < run[1].begin; ++i)
        integral_us += stays_[i].duration_us * growth(stays_[i].level);
      out[run->pixel] = fast_log2(integral_us / duration_us_);
    }
  }
}

}  // namespace nightjar::esi
