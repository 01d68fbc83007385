#include "esi/edi.h"

#include "esi/fast_math.h"

namespace nightjar::esi {

Edi::Edi(const DoubleIntegralConfig& config, core::Resolution size)
    : DoubleIntegral(config, size, "edi") {
  reset();
}

void Edi::log_means(const Growth& growth, SharpnessRows, core::Image<float>& log2) {
  cells_.assign(log2.pixels().size(), Cell{0, exposure_.begin_us, 0});
  for (const PackedEvent& e : exposure_.events) {
    Cell& cell = cells_[e.pixel()];
    cell.integral_us += (e.t_us - cell.t_us) * growth(Growth::level(cell.level));
    cell.t_us = e.t_us;
    cell.level += e.on() ? 1 : -1;
  }
  const double duration_us = exposure_.end_us - exposure_.begin_us;
  float* out = log2.pixels().data();
  for (const Cell& cell : cells_) {
    const double rest_us = (exposure_.end_us - cell.t_us) * growth(Growth::level(cell.level));
    *out++ = fast_log2((cell.integral_us + rest_us) / duration_us);
  }
}

}  // namespace nightjar::esi
