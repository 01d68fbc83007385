#include "esi/memory_cell.h"

#include <algorithm>

#include "core/instruction_sets.h"
#include "esi/memory_cell_blocks.h"
#include "esi/memory_cell_constants.h"
#include "esi/memory_cell_x86.h"

namespace nightjar::esi {
namespace {

// A whole cell at once; compilers split what is wider than the processor's registers.
using Floats [[gnu::vector_size(4 * kMemoryLanes), gnu::may_alias]] = float;
using Ints [[gnu::vector_size(4 * kMemoryLanes), gnu::may_alias]] = std::int32_t;
using Shorts [[gnu::vector_size(2 * kMemoryLanes), gnu::may_alias, gnu::aligned(2)]] = std::int16_t;

const Floats& floats(const float* lanes) { return *reinterpret_cast<const Floats*>(lanes); }
const Ints& ints(const std::int32_t* lanes) { return *reinterpret_cast<const Ints*>(lanes); }

inline void take(const PackedEvent& e, MemoryCell* cells) {
  const MemoryConstants& c = kMemoryConstants;
  MemoryCell& cell = cells[e.pixel()];
  const auto age_us = static_cast<std::int32_t>(e.t_us - cell.t_us);
  const Floats age = __builtin_convertvector(Ints{} + age_us, Floats);
  Floats left = 1.0f - floats(c.rate_per_us) * age;
  left = left > 0.0f ? left : Floats{};
  // The time's bits would be a very small number, or none.
  Floats sum = reinterpret_cast<Floats>(reinterpret_cast<Ints&>(cell) & ints(c.is_sum));
  sum = (sum + floats(c.step[e.on()].before)) * left + floats(c.step[e.on()].after);
  sum = sum > floats(c.least) ? sum : floats(c.least);
  sum = sum < floats(c.most) ? sum : floats(c.most);
  const Ints time = (Ints{} + static_cast<std::int32_t>(e.t_us)) & ints(c.is_time);
  reinterpret_cast<Ints&>(cell) = reinterpret_cast<Ints>(sum) | time;
}

[[gnu::always_inline]] inline void feature(const MemoryCell& cell, std::uint32_t now_us,
                                           std::int16_t* to) {
  const MemoryConstants& c = kMemoryConstants;
  const auto age_us = static_cast<std::int32_t>(std::min(now_us - cell.t_us, 0x7fffffffu));
  const Floats age = __builtin_convertvector(Ints{} + age_us, Floats);
  Floats left = 1.0f - floats(c.rate_per_us) * age;
  left = left > floats(c.stays) ? left : floats(c.stays);
  const Ints is_sum = ints(c.is_sum);
  const Floats sum = reinterpret_cast<Floats>(reinterpret_cast<const Ints&>(cell) & is_sum) * left;
  const Floats size = is_sum ? (sum > 0.0f ? sum : -sum) : age;
  const Floats over = is_sum ? sum : Floats{} + 1.0f;
  const Floats value = floats(c.scale) * over / (1.0f + floats(c.squeeze) * size);
  const Ints whole =
      __builtin_convertvector(value * float{kFeatureOne} + (kFeatureLift + 0.5f), Ints) -
      kFeatureLift;
  *reinterpret_cast<Shorts*>(to) = __builtin_convertvector(whole, Shorts);
}

[[gnu::always_inline]] inline void features_body(const MemoryCell* cells, int width,
                                                 std::uint32_t now_us, std::int16_t* to) {
  int x = 0;
  for (; x + 2 <= width; x += 2, to += 4 * kPixelFeatures) {
    feature(cells[x], now_us, to);
    feature(cells[x + 1], now_us, to + kPixelFeatures);
  }
  if (x == width) return;
  feature(cells[x], now_us, to);
  feature(cells[x], now_us, to + kPixelFeatures);
}

void integrate_plain(EventRun& events, MemoryCell* cells) { integrate_blocks<take>(events, cells); }
void features_plain(const MemoryCell* cells, int width, std::uint32_t now_us, std::int16_t* to) {
  features_body(cells, width, now_us, to);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void features_avx2(const MemoryCell* cells, int width, std::uint32_t now_us,
                                           std::int16_t* to) {
  features_body(cells, width, now_us, to);
}
#endif

}  // namespace

std::vector<MemoryVariant> memory_variants() {
  std::vector<MemoryVariant> variants{{"plain", integrate_plain, features_plain}};
#if defined(__x86_64__)
  const core::InstructionSets sets = core::instruction_sets();
  if (sets.avx2) variants.push_back({"avx2", integrate_avx2, features_avx2});
  if (sets.avx512) variants.push_back({"avx512", integrate_avx512, features_avx512});
#endif
  return variants;
}

const MemoryVariant& best_memory_variant() {
  static const MemoryVariant variant = memory_variants().back();
  return variant;
}

}  // namespace nightjar::esi
