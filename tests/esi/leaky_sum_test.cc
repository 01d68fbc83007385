#include "esi/leaky_sum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/random.h"

namespace nightjar::esi {
namespace {

constexpr std::size_t kPixels = 500;

LeakySum make(Leak leak, double rate_hz, double power = 1) {
  LeakySum sum(leak, rate_hz, power);
  sum.step = {-0.2f, 0.2f};
  sum.least = -1;
  sum.greatest = 1;
  return sum;
}

std::vector<LeakySum> all_kinds() {
  std::vector<LeakySum> kinds;
  for (const bool leak_first : {false, true})
    for (const LeakySum& sum :
         {make(Leak::linear, 1.0), make(Leak::linear, 0), make(Leak::power, 1.0, 2.5),
          make(Leak::power, 0.5, 0.5), make(Leak::power, 20, 0.5), make(Leak::power, 0.7, 0.01),
          make(Leak::power, 1000, 20), make(Leak::power, 3, 12), make(Leak::power, 0, 3),
          make(Leak::exponential, 1.4), make(Leak::slope, 0.5)}) {
      kinds.push_back(sum);
      kinds.back().leak_first = leak_first;
    }
  return kinds;
}

/// With all times between events from 0 to 2^31 us; time wraps on the way. A share of them at
/// five pixels, again and again: of sixteen in a row some are then at the same pixel.
std::vector<PackedEvent> events(std::size_t count, std::uint64_t seed, double share = 0.5) {
  core::Random random = core::random_stream(seed, "test.leaky_sum");
  std::vector<PackedEvent> all;
  std::uint32_t t_us = 4'000'000'000u;
  for (std::size_t i = 0; i < count; ++i) {
    t_us += static_cast<std::uint32_t>(std::pow(2.0, 14 * core::uniform01(random))) - 1;
    const std::uint64_t pixel = random() % (core::uniform01(random) < share ? 5 : kPixels);
    all.push_back({t_us, static_cast<std::uint32_t>(2 * pixel + random() % 2)});
  }
  return all;
}

void integrate(const LeakySumVariant& variant, const LeakySum& sum,
               std::span<const PackedEvent> all, SumCell* cells) {
  EventRun run(all);
  variant.integrate(sum, run, cells);
}

std::vector<SumCell> run(const LeakySumVariant& variant, const LeakySum& sum,
                         std::span<const PackedEvent> all, std::size_t batch) {
  std::vector<SumCell> cells(kPixels, SumCell{0, 4'000'000'000u});
  for (; !all.empty(); all = all.subspan(std::min(batch, all.size())))
    integrate(variant, sum, all.first(std::min(batch, all.size())), cells.data());
  return cells;
}

bool same_bits(const std::vector<SumCell>& a, const std::vector<SumCell>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(SumCell)) == 0;
}

class LeakySumOfRepeats : public testing::TestWithParam<double> {};

TEST_P(LeakySumOfRepeats, EveryInstructionSetAndEveryCutGivesTheSameBits) {
  const auto all = events(20000, /*seed=*/1, GetParam());
  const auto variants = leaky_sum_variants();
  for (const LeakySum& sum : all_kinds()) {
    const auto expected = run(variants.front(), sum, all, all.size());
    for (const LeakySumVariant& variant : variants)
      for (const std::size_t batch :
           {std::size_t{1}, std::size_t{127}, std::size_t{129}, std::size_t{1000}, all.size()})
        EXPECT_TRUE(same_bits(run(variant, sum, all, batch), expected))
            << variant.name << ' ' << batch << ' ' << static_cast<int>(sum.leak);
  }
}

INSTANTIATE_TEST_SUITE_P(AllAndFew, LeakySumOfRepeats, testing::Values(0.0, 0.03, 0.5));

TEST(LeakySum, EveryInstructionSetLosesTheSameAfterEveryTime) {
  constexpr std::uint32_t kTimes = 100'100;  // up to 1/k and beyond
  std::vector<PackedEvent> all;
  for (std::uint32_t i = 0; i < kTimes; ++i) all.push_back({i, 2 * i});
  const auto variants = leaky_sum_variants();
  for (const auto& [rate_hz, power] : {std::pair{10.0, 0.01},
                                       {10.0, 0.3},
                                       {10.0, 1.0},
                                       {10.0, 1.7},
                                       {10.0, 12.0},
                                       {1000.0, 0.3},
                                       {1000.0, 3.0}}) {
    LeakySum sum = make(Leak::power, rate_hz, power);
    sum.step = {0, 0};
    std::vector<SumCell> expected(kTimes, SumCell{1, 0});
    integrate(variants.front(), sum, all, expected.data());
    for (const LeakySumVariant& variant : variants) {
      std::vector<SumCell> cells(kTimes, SumCell{1, 0});
      integrate(variant, sum, all, cells.data());
      EXPECT_TRUE(same_bits(cells, expected)) << variant.name << ' ' << rate_hz << ' ' << power;
    }
  }
}

TEST(LeakySum, EveryInstructionSetDrawsTheSame) {
  const auto all = events(20000, /*seed=*/2);
  const auto variants = leaky_sum_variants();
  for (const LeakySum& sum : all_kinds()) {
    const auto cells = run(variants.front(), sum, all, all.size());
    for (const bool leak : {false, true})
      for (const std::uint32_t later_us : {0u, 300'000u, 0x7fffffffu, 0xbfffffffu}) {
        std::vector<std::uint8_t> expected(kPixels);
        const std::uint32_t now_us = all.back().t_us + later_us;
        variants.front().draw(sum, leak, now_us, cells, expected.data());
        for (const LeakySumVariant& variant : variants) {
          std::vector<std::uint8_t> gray(kPixels);
          variant.draw(sum, leak, now_us, cells, gray.data());
          EXPECT_EQ(gray, expected) << variant.name;
        }
      }
  }
}

TEST(LeakySum, DrawsATimeThatIsTooLongAsTheLongestThereIs) {
  const LeakySum sum = make(Leak::linear, 1e-4);  // a fifth is lost by then
  const std::vector<SumCell> cells = {{1.0f, 5}};
  std::uint8_t gray = 0;
  for (const std::uint32_t age_us : {0x7fffffffu, 0x80000000u, 0xbfffffffu}) {
    best_leaky_sum_variant().draw(sum, true, 5 + age_us, cells, &gray);
    EXPECT_EQ(gray, 228) << age_us;  // 255 (1 + 1 - 1e-4 * 2147.5) / 2
  }
}

/// What is lost of a sum of 1 after `age_us`.
double lost(LeakySum sum, std::uint32_t age_us) {
  sum.step = {0, 0};
  SumCell cell{1, 0};
  integrate(best_leaky_sum_variant(), sum, std::vector<PackedEvent>{{age_us, 1}}, &cell);
  return 1.0 - static_cast<double>(cell.sum);
}

TEST(LeakySum, LosesWhatTheFormulaSays) {
  for (const double rate_hz : {1e-5, 0.01, 0.5, 1.0, 3.0, 100.0, 1000.0})
    for (const double power : {0.01, 0.1, 0.25, 0.3, 0.49, 0.5, 0.6, 0.99, 1.0, 1.01, 1.2, 1.8, 2.0,
                               2.5, 8.0, 8.1, 20.0, 32.0})
      for (double age_us = 0; age_us < 2147483647; age_us = 1.37 * age_us + 1) {
        const auto age = static_cast<std::uint32_t>(age_us);
        const double left = std::max(1 - 1e-6 * rate_hz * age, 0.0);
        // What the header promises of what is lost, the float that the sum is, and 1 - k dt in
        // floats, which matters next to 0.
        const double near_end = left > 0 && left < 0.7 ? power * 2e-7 / left : 0;
        const double promised = power > 1 ? 1.2e-3 : power < 0.25 ? 5e-5 : 3e-5;
        const double tolerance =
            promised * (1 - std::pow(left, power)) + 6e-8 + std::pow(left, power) * near_end;
        ASSERT_NEAR(lost(make(Leak::power, rate_hz, power), age), 1 - std::pow(left, power),
                    tolerance)
            << rate_hz << ' ' << power << ' ' << age;
        ASSERT_NEAR(lost(make(Leak::exponential, rate_hz), age),
                    1 - std::exp2(-1e-6 * rate_hz * age), 3e-5)
            << rate_hz << ' ' << age;
      }
}

TEST(LeakySum, LosesNothingAtOnceAndAllWhenItIsTime) {
  for (const double power : {0.01, 0.5, 1.0, 2.5, 20.0}) {
    for (const double rate_hz : {0.0, 1e-9, 0.3, 1.0, 1000.0})
      EXPECT_EQ(lost(make(Leak::power, rate_hz, power), 0), 0.0);
    for (double rate_hz = 0.001; rate_hz < 1000; rate_hz *= 1.37) {
      const LeakySum sum = make(Leak::power, rate_hz, power);
      const auto gone_us = static_cast<std::uint32_t>(std::ceil(1e6 / rate_hz));
      EXPECT_EQ(lost(sum, gone_us), 1.0) << rate_hz;
      EXPECT_EQ(lost(sum, 2 * gone_us), 1.0) << rate_hz;
      EXPECT_LT(lost(sum, gone_us - 1), 1.0 + 1e-7) << rate_hz;
    }
  }
}

TEST(LeakySum, AManyTimesRepeatedShortIntervalLosesWhatALongOneOfAnExponentialDoes) {
  // 100,000 events 20 us apart: a decay that is off by a bias would be off 100,000 times.
  LeakySum sum = make(Leak::exponential, 1.0);
  sum.step = {0, 0};
  SumCell cell{1, 0};
  std::vector<PackedEvent> all;
  for (std::uint32_t i = 1; i <= 100'000; ++i) all.push_back({20 * i, 1});
  integrate(best_leaky_sum_variant(), sum, all, &cell);
  // 2 s: 2^-2. Each step is rounded by up to half of 2^-24 of the sum; a random walk of
  // 100,000 such steps is within 6e-8 * sqrt(100,000) = 2e-5 of it.
  EXPECT_NEAR(cell.sum, 0.25, 0.25 * (3e-5 * 2 * std::log(2.0) + 1e-4));
}

TEST(LeakySum, ASlopeStopsAtZeroFromEitherSide) {
  LeakySum sum = make(Leak::slope, 0.5);
  sum.leak_first = true;
  std::vector<SumCell> cells(2);
  const auto take = [&](std::uint32_t t_us, std::uint32_t pixel, bool on) {
    integrate(best_leaky_sum_variant(), sum,
              std::vector<PackedEvent>{{t_us, 2 * pixel + std::uint32_t{on}}}, cells.data());
  };
  take(0, 0, true);
  take(0, 1, false);
  take(200'000, 0, true);   // 0.2 - 0.1 + 0.2
  take(200'000, 1, false);  // the same below
  EXPECT_FLOAT_EQ(cells[0].sum, 0.3f);
  EXPECT_FLOAT_EQ(cells[1].sum, -0.3f);
  take(900'000, 0, false);
  take(900'000, 1, true);
  EXPECT_FLOAT_EQ(cells[0].sum, -0.2f);
  EXPECT_FLOAT_EQ(cells[1].sum, 0.2f);
}

}  // namespace
}  // namespace nightjar::esi
