#include "esi/memory_cell.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/random.h"

namespace nightjar::esi {
namespace {

constexpr std::uint32_t kStart_us = 4'294'000'000u;  // time wraps 1 s later

/// `count` events at `pixels` pixels, gaps between any two of them from 0 to 2^most_log2 us.
std::vector<PackedEvent> events(std::size_t count, std::uint64_t pixels, double most_log2,
                                std::uint64_t seed) {
  core::Random random = core::random_stream(seed, "test.memory_cell");
  std::vector<PackedEvent> all;
  std::uint32_t t_us = kStart_us;
  for (std::size_t i = 0; i < count; ++i) {
    t_us += static_cast<std::uint32_t>(std::exp2(most_log2 * core::uniform01(random))) - 1;
    all.push_back({t_us, static_cast<std::uint32_t>(2 * (random() % pixels) + random() % 2)});
  }
  return all;
}

void integrate(const MemoryVariant& variant, std::span<const PackedEvent> all, MemoryCell* cells) {
  EventRun run(all);
  variant.integrate(run, cells);
}

std::vector<MemoryCell> run(const MemoryVariant& variant, std::span<const PackedEvent> all,
                            std::size_t pixels, std::size_t batch) {
  std::vector<MemoryCell> cells(pixels, MemoryCell{{}, kStart_us});
  for (; !all.empty(); all = all.subspan(std::min(batch, all.size())))
    integrate(variant, all.first(std::min(batch, all.size())), cells.data());
  return cells;
}

TEST(MemoryCell, every_instruction_set_and_every_cut_gives_the_same_bits) {
  const auto all = events(20'000, 300, 13, /*seed=*/1);
  const auto expected = run(memory_variants().front(), all, 300, all.size());
  for (const MemoryVariant& variant : memory_variants())
    for (const std::size_t batch :
         {std::size_t{1}, std::size_t{127}, std::size_t{129}, std::size_t{300}, all.size()}) {
      const auto cells = run(variant, all, 300, batch);
      EXPECT_EQ(std::memcmp(cells.data(), expected.data(), sizeof(MemoryCell) * 300), 0)
          << variant.name << ' ' << batch;
    }
}

TEST(MemoryCell, every_instruction_set_gives_the_same_bits_after_every_event) {
  // Up to 17 s apart: 0.5 Hz forgets within 2 s, and what is left of a minus sum is 0.
  const auto all = events(3000, 3, 24, /*seed=*/4);
  for (const MemoryVariant& variant : memory_variants()) {
    std::vector<MemoryCell> expected(3, MemoryCell{{}, kStart_us}), cells = expected;
    for (const PackedEvent& e : all) {
      integrate(memory_variants().front(), {&e, 1}, expected.data());
      integrate(variant, {&e, 1}, cells.data());
      ASSERT_EQ(std::memcmp(cells.data(), expected.data(), sizeof(MemoryCell) * 3), 0)
          << variant.name << ' ' << &e - all.data();
    }
  }
}

TEST(MemoryCell, every_instruction_set_gives_the_same_features) {
  const auto all = events(20'000, 300, 13, /*seed=*/2);
  const auto cells = run(memory_variants().front(), all, 300, all.size());
  for (const std::uint32_t later_us : {0u, 1u, 100'000u, 0x7fffffffu, 0xbfffffffu}) {
    const std::uint32_t now_us = all.back().t_us + later_us;
    std::vector<std::int16_t> expected(300 * 2 * kPixelFeatures);
    memory_variants().front().features(cells.data(), 299, now_us, expected.data());
    for (const MemoryVariant& variant : memory_variants()) {
      // A row ends in the middle of its last block: of the lower pixels nothing is written.
      std::vector<std::int16_t> features(expected.size());
      variant.features(cells.data(), 299, now_us, features.data());
      EXPECT_EQ(features, expected) << variant.name << ' ' << later_us;
    }
  }
}

/// The header's formulas in doubles.
struct Reference {
  void take(double dt_s, bool on) {
    for (std::size_t i = 0; i < kMemories; ++i) {
      const Memory& m = kPixelMemories[i];
      const double left = std::max(1 - double{m.rate_hz} * dt_s, 0.0);
      const double e = on || m.activity ? 1 : -1;
      const double value = m.moving ? sum[i] * left + e : (sum[i] + e) * left;
      sum[i] = std::clamp(value, -double{m.most_events}, double{m.most_events});
    }
  }

  double feature(std::size_t i, double age_s) const {
    if (i == kMemories) return 1 / (1 + age_s / 0.1);
    const Memory& m = kPixelMemories[i];
    const double v = m.moving ? sum[i] * std::max(1 - double{m.rate_hz} * age_s, 0.0) : sum[i];
    return m.most_events > 10 ? v / (2 + std::abs(v) / 2) : 2 * v / double{m.most_events};
  }

  std::array<double, kMemories> sum{};
};

TEST(MemoryCell, sums_and_features_are_those_of_the_formulas) {
  core::Random random = core::random_stream(/*seed=*/3, "test.memory_cell");
  MemoryCell cell{{}, kStart_us};
  Reference reference;
  std::uint32_t t_us = kStart_us;
  for (int n = 0; n < 3000; ++n) {
    const auto dt_us = static_cast<std::uint32_t>(std::exp2(22 * core::uniform01(random)));
    const bool on = core::uniform01(random) < 0.7;
    t_us += dt_us;
    integrate(best_memory_variant(), std::vector<PackedEvent>{{t_us, on ? 1u : 0u}}, &cell);
    reference.take(1e-6 * dt_us, on);
    for (std::size_t i = 0; i < kMemories; ++i)  // 32 events at most, a float's 24 bits, a few
      ASSERT_NEAR(cell.sum[i], reference.sum[i], 32 * 1e-6) << n << ' ' << i;  // operations

    std::array<std::int16_t, 2 * kPixelFeatures> features;
    const auto age_us = static_cast<std::uint32_t>(std::exp2(22 * core::uniform01(random)));
    best_memory_variant().features(&cell, 1, t_us + age_us, features.data());
    for (std::size_t i = 0; i < kPixelFeatures; ++i)  // half of one, and where it is near a half
      ASSERT_NEAR(features[i], kFeatureOne * reference.feature(i, 1e-6 * age_us), 0.51)
          << n << ' ' << i;
  }
}

TEST(MemoryCell, takes_two_events_as_worked_out_by_hand) {
  MemoryCell cell;
  // 100 ms after the start, and 100 ms later.
  integrate(best_memory_variant(), std::vector<PackedEvent>{{100'000, 1}, {200'000, 0}}, &cell);
  EXPECT_EQ(cell.t_us, 200'000u);
  EXPECT_FLOAT_EQ(cell.sum[0], (0.95f - 1) * 0.95f);  // as ESI, 0.5 Hz
  EXPECT_FLOAT_EQ(cell.sum[1], (0.95f - 1) * 0.95f);  // the same: 1.5 events are not reached
  EXPECT_FLOAT_EQ(cell.sum[2], 0.9f - 1);             // moving, 1 Hz
  EXPECT_FLOAT_EQ(cell.sum[3], -1.0f);                // moving, 15 Hz: all gone
  EXPECT_FLOAT_EQ(cell.sum[5], -1.0f);                // moving, 150 Hz: gone after 7 ms
  EXPECT_FLOAT_EQ(cell.sum[6], 0.8f + 1);             // activity, 2 Hz
}

TEST(MemoryCell, writes_blocks_and_doubles_an_odd_last_cell) {
  std::vector<MemoryCell> cells(3);
  for (std::uint32_t x = 0; x < 3; ++x)
    integrate(best_memory_variant(), std::vector<PackedEvent>(x + 1, {0, 2 * x + 1}), cells.data());
  std::vector<std::int16_t> features(2 * 4 * kPixelFeatures, -1);
  best_memory_variant().features(cells.data(), 3, 0, features.data());
  const auto first = [&](std::size_t at) { return features[at * kPixelFeatures]; };
  // 1, 2 and 3 ON events of at most 5: 2/5, 4/5 and 6/5 of 512.
  EXPECT_EQ(first(0), 205);
  EXPECT_EQ(first(1), 410);
  EXPECT_EQ(first(2), -1);  // of the block's lower row, which is not this one
  EXPECT_EQ(first(4), 614);
  EXPECT_EQ(first(5), 614);
  EXPECT_EQ(first(6), -1);
}

TEST(MemoryCell, ages_beyond_31_bits_count_as_very_long) {
  MemoryCell cell;
  integrate(best_memory_variant(), std::vector<PackedEvent>{{0, 1}}, &cell);
  std::array<std::int16_t, 2 * kPixelFeatures> longest, beyond;
  for (const MemoryVariant& variant : memory_variants()) {
    variant.features(&cell, 1, 0x7fffffffu, longest.data());
    EXPECT_EQ(longest[0], 205);  // stays
    EXPECT_EQ(longest[3], 0);    // gone
    EXPECT_EQ(longest[kMemories], 0);
    for (const std::uint32_t age_us : {0x80000000u, 0xbfffffffu, 0xffffffffu}) {
      variant.features(&cell, 1, age_us, beyond.data());
      EXPECT_EQ(beyond, longest) << variant.name << ' ' << age_us;
    }
  }
}

}  // namespace
}  // namespace nightjar::esi
