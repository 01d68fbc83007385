#include "esi/memory_cell.h"

#include <algorithm>

#include "core/instruction_sets.h"

namespace nightjar::esi {
namespace {

constexpr int kLanes = kMemories + 1;  // the sums, and one for the time
constexpr int kTime = kMemories;
static_assert(sizeof(MemoryCell) == kLanes * sizeof(float));

// A whole cell at once; compilers split what is wider than the processor's registers.
using Floats [[gnu::vector_size(4 * kLanes), gnu::may_alias]] = float;
using Ints [[gnu::vector_size(4 * kLanes), gnu::may_alias]] = std::int32_t;
using Shorts [[gnu::vector_size(2 * kLanes), gnu::may_alias, gnu::aligned(2)]] = std::int16_t;

/// kPixelMemories, a register for each member, and something harmless in the time's place.
struct alignas(32) Constants {
  float rate_per_us[kLanes] = {};
  float most[kLanes] = {};
  float least[kLanes] = {};
  float before[2][kLanes] = {};       ///< Added ahead of the decay by an OFF and an ON event: ESI.
  float after[2][kLanes] = {};        ///< And behind it: moving.
  std::int32_t is_sum[kLanes] = {};   ///< All ones, or 0.
  std::int32_t is_time[kLanes] = {};  ///< The same.
  float stays[kLanes] = {};           ///< 1 where nothing decays up to the picture.
  /// A feature is scale v / (1 + squeeze |v|), the time's 1 / (1 + squeeze age).
  float scale[kLanes] = {};
  float squeeze[kLanes] = {};
};

constexpr Constants make_constants() {
  Constants c;
  for (int i = 0; i < kMemories; ++i) {
    const Memory& m = kPixelMemories[static_cast<std::size_t>(i)];
    c.rate_per_us[i] = m.rate_hz * 1e-6f;
    c.most[i] = m.most_events;
    c.least[i] = -m.most_events;
    auto& added = m.moving ? c.after : c.before;
    added[0][i] = m.activity ? 1.0f : -1.0f;
    added[1][i] = 1.0f;
    c.is_sum[i] = -1;
    c.stays[i] = m.moving ? 0.0f : 1.0f;
    const bool is_long = m.most_events > 10.0f;
    c.scale[i] = is_long ? 0.5f : 2.0f / m.most_events;
    c.squeeze[i] = is_long ? 0.25f : 0.0f;
  }
  c.is_time[kTime] = -1;
  c.scale[kTime] = 1.0f;
  c.squeeze[kTime] = 1e-5f;  // 1 / (100 ms)
  return c;
}

constexpr Constants kConstants = make_constants();

const Floats& floats(const float* lanes) { return *reinterpret_cast<const Floats*>(lanes); }
const Ints& ints(const std::int32_t* lanes) { return *reinterpret_cast<const Ints*>(lanes); }

[[gnu::always_inline]] inline void take(const PackedEvent& e, MemoryCell* cells) {
  const Constants& c = kConstants;
  MemoryCell& cell = cells[e.pixel()];
  const auto age_us = static_cast<std::int32_t>(e.t_us - cell.t_us);
  const Floats age = __builtin_convertvector(Ints{} + age_us, Floats);
  Floats left = 1.0f - floats(c.rate_per_us) * age;
  left = left > 0.0f ? left : Floats{};
  // The time's bits would be a very small number, or none.
  Floats sum = reinterpret_cast<Floats>(reinterpret_cast<Ints&>(cell) & ints(c.is_sum));
  sum = (sum + floats(c.before[e.on()])) * left + floats(c.after[e.on()]);
  sum = sum > floats(c.least) ? sum : floats(c.least);
  sum = sum < floats(c.most) ? sum : floats(c.most);
  const Ints time = (Ints{} + static_cast<std::int32_t>(e.t_us)) & ints(c.is_time);
  reinterpret_cast<Ints&>(cell) = reinterpret_cast<Ints>(sum) | time;
}

/// A block's cells, which come from the second or third cache, are on their way while the
/// block before it is taken.
[[gnu::always_inline]] inline void integrate_body(EventRun& events, MemoryCell* cells) {
  constexpr std::size_t kBlock = 64;
  EventRun run = events;
  auto block = run.next(kBlock);
  while (!block.empty()) {
    const auto next = run.next(kBlock);  // no longer than `block`
    for (std::size_t i = 0; i < next.size(); ++i) {
      __builtin_prefetch(cells + next[i].pixel(), 1);
      take(block[i], cells);
    }
    for (const PackedEvent& e : block.subspan(next.size())) take(e, cells);
    block = next;
  }
  events = run;
}

[[gnu::always_inline]] inline void feature(const MemoryCell& cell, std::uint32_t now_us,
                                           std::int16_t* to) {
  const Constants& c = kConstants;
  const auto age_us = static_cast<std::int32_t>(std::min(now_us - cell.t_us, 0x7fffffffu));
  const Floats age = __builtin_convertvector(Ints{} + age_us, Floats);
  Floats left = 1.0f - floats(c.rate_per_us) * age;
  left = left > floats(c.stays) ? left : floats(c.stays);
  const Ints is_sum = ints(c.is_sum);
  const Floats sum = reinterpret_cast<Floats>(reinterpret_cast<const Ints&>(cell) & is_sum) * left;
  const Floats size = is_sum ? (sum > 0.0f ? sum : -sum) : age;
  const Floats over = is_sum ? sum : Floats{} + 1.0f;
  const Floats value = floats(c.scale) * over / (1.0f + floats(c.squeeze) * size);
  // Above 0, where dropping the fraction rounds downwards.
  constexpr int kLift = 2 * kFeatureOne;
  const Ints whole =
      __builtin_convertvector(value * float{kFeatureOne} + (kLift + 0.5f), Ints) - kLift;
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

void integrate_plain(EventRun& events, MemoryCell* cells) { integrate_body(events, cells); }
void features_plain(const MemoryCell* cells, int width, std::uint32_t now_us, std::int16_t* to) {
  features_body(cells, width, now_us, to);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void integrate_avx2(EventRun& events, MemoryCell* cells) {
  integrate_body(events, cells);
}
[[gnu::target("avx2")]] void features_avx2(const MemoryCell* cells, int width, std::uint32_t now_us,
                                           std::int16_t* to) {
  features_body(cells, width, now_us, to);
}
#endif

}  // namespace

std::vector<MemoryVariant> memory_variants() {
  std::vector<MemoryVariant> variants{{"plain", integrate_plain, features_plain}};
#if defined(__x86_64__)
  if (core::instruction_sets().avx2) variants.push_back({"avx2", integrate_avx2, features_avx2});
#endif
  return variants;
}

const MemoryVariant& best_memory_variant() {
  static const MemoryVariant variant = memory_variants().back();
  return variant;
}

}  // namespace nightjar::esi
