#include "esi/htac.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/events.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;
using Gray = core::Image<std::uint8_t>;

constexpr core::Resolution kSensor{16, 12};

Gray picture_of(Htac& htac, core::Time t) {
  core::Picture picture;
  htac.render(t, picture);
  return picture.gray;
}

int gray_of(double sum) { return static_cast<int>(std::lround(255.0 * (sum + 1.0) / 2.0)); }

/// The description in doubles: each pixel with its own time, brought up to each event near it.
Gray by_the_description(const HtacConfig& c, const std::vector<core::Event>& events,
                        core::Time at) {
  struct Cell {
    double sum = 0, t_s = 0;
  };
  core::Image<Cell> cells(kSensor);
  double total = 0;
  const auto weight = [&](int dx, int dy) {
    const int d2 = dx * dx + dy * dy;
    return c.sigma_px > 0 ? std::exp(-d2 / (2 * c.sigma_px * c.sigma_px)) : (d2 == 0 ? 1.0 : 0.0);
  };
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) total += weight(dx, dy);
  for (const core::Event& e : events)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = e.x + dx, y = e.y + dy;
        if (x < 0 || y < 0 || x >= kSensor.width_px || y >= kSensor.height_px) continue;
        Cell& cell = cells(x, y);
        cell.sum *= std::exp(-(core::seconds(e.t) - cell.t_s) / c.decay_time_s);
        cell.sum += (e.on ? 1 : -1) * c.contrast_log * weight(dx, dy) / total;
        cell.sum = std::clamp(cell.sum, c.least_log, c.greatest_log);
        cell.t_s = core::seconds(e.t);
      }
  Gray gray(kSensor);
  for (std::size_t i = 0; i < gray.pixels().size(); ++i) {
    const Cell& cell = cells.pixels()[i];
    const double sum = cell.sum * std::exp(-(core::seconds(at) - cell.t_s) / c.decay_time_s);
    gray.pixels()[i] = static_cast<std::uint8_t>(
        std::lround(255.0 * (sum - c.least_log) / (c.greatest_log - c.least_log)));
  }
  return gray;
}

TEST(Htac, AgreesWithTheDescriptionWithinAGreyLevel) {
  // At 1 ms a pixel's unit grows by 2^32 every 22 ms: the epoch moves on 900 times.
  for (const double decay_time_s : {0.001, 0.1, 1.0, 1000.0})
    for (const double sigma_px : {0.0, 0.7, 3.0}) {
      HtacConfig config;
      config.decay_time_s = decay_time_s;
      config.sigma_px = sigma_px;
      config.greatest_log = 0.6;
      const auto events = test::random_events(kSensor, 40000, 20s, /*seed=*/3);
      Htac htac(config, kSensor);
      htac.process(events);
      const core::Time at = events.back().t + 700us;
      const Gray gray = picture_of(htac, at), expected = by_the_description(config, events, at);
      for (std::size_t i = 0; i < gray.pixels().size(); ++i)
        // Sums are floats: only a value on the edge between two levels may differ.
        ASSERT_NEAR(gray.pixels()[i], expected.pixels()[i], 1) << decay_time_s << ' ' << sigma_px;
    }
}

TEST(Htac, HandWorkedEventInACorner) {
  // sigma 0.7: exp(-1/0.98) = 0.3604; sum (1 + 2 * 0.3604)^2 = 2.9622. c = 1: the middle gets
  // 0.3376, the side 0.1217, the corner 0.0439; what falls off the sensor is lost.
  HtacConfig config;
  config.contrast_log = 1.0;
  Htac htac(config, kSensor);
  htac.process(std::vector<core::Event>{{1s, 0, 0, true}});
  Gray gray = picture_of(htac, 1s);
  EXPECT_EQ(gray(0, 0), gray_of(0.3376));
  EXPECT_EQ(gray(1, 0), gray_of(0.1217));
  EXPECT_EQ(gray(0, 1), gray_of(0.1217));
  EXPECT_EQ(gray(1, 1), gray_of(0.0439));
  EXPECT_EQ(gray(15, 0), gray_of(0)) << "around the edge";
  EXPECT_EQ(gray(2, 0), gray_of(0));
  gray = picture_of(htac, 2s);  // one time constant on
  EXPECT_EQ(gray(0, 0), gray_of(0.3376 * 0.36788));
}

TEST(Htac, ClampHoldsAHotPixelAndAnswersAtOnceWhenItTurns) {
  HtacConfig config;
  config.sigma_px = 0;
  config.decay_time_s = 100;
  Htac htac(config, kSensor);
  std::vector<core::Event> hot;
  for (int i = 1; i <= 1000; ++i) hot.push_back({i * 1us, 5, 5, true});
  htac.process(hot);
  EXPECT_EQ(picture_of(htac, 1ms)(5, 5), 255);
  htac.process(std::vector<core::Event>{{1001us, 5, 5, false}});
  EXPECT_EQ(picture_of(htac, 1001us)(5, 5), gray_of(1.0 - 0.2));
}

TEST(Htac, NothingIsLeftAfterHoursWithoutEvents) {
  Htac htac({}, kSensor);
  htac.process(std::vector<core::Event>{{1s, 5, 5, true}});
  htac.process(std::vector<core::Event>{{5h, 9, 9, true}});
  const Gray gray = picture_of(htac, 5h);
  EXPECT_EQ(gray(5, 5), gray_of(0));
  EXPECT_EQ(gray(9, 9), gray_of(0.2 * 0.3376));
}

TEST(Htac, SlowDecayGoesOnOverHours) {
  // 1000 s to 1/e, an event elsewhere every 10 minutes: after 2 h a pixel has decayed by e^-7.2.
  HtacConfig config;
  config.decay_time_s = 1000;
  config.contrast_log = 2;
  config.sigma_px = 0;
  Htac htac(config, kSensor);
  htac.process(std::vector<core::Event>{{1us, 5, 5, true}});
  EXPECT_EQ(picture_of(htac, 10min)(5, 5), gray_of(std::exp(-0.6)));
  for (int i = 1; i <= 12; ++i)
    htac.process(std::vector<core::Event>{{i * 10min, 9, 9, i % 2 == 0}});
  EXPECT_EQ(picture_of(htac, 2h)(5, 5), gray_of(std::exp(-7.2)));
}

TEST(Htac, AGapBeyond32BitsCountsAsTheMostAge) {
  // 600 s between events count in full; of the 71.6 minutes that follow, 2^30 us do.
  HtacConfig config;
  config.decay_time_s = 1000;
  config.contrast_log = 2;
  config.sigma_px = 0;
  Htac htac(config, kSensor);
  const core::Time late = 601s + core::Time(std::int64_t{1} << 32);
  htac.process(std::vector<core::Event>{{1us, 5, 5, true}, {600s, 9, 9, true}, {late, 9, 9, true}});
  EXPECT_EQ(picture_of(htac, late)(5, 5), gray_of(std::exp(-0.6 - 1.073742)));
}

TEST(Htac, SensorsOfOneColumnAndOfOddWidthFindTheirRows) {
  for (const core::Resolution size : {core::Resolution{1, 40}, {3, 40}, {641, 4}, {32767, 2}}) {
    HtacConfig config;
    config.sigma_px = 0;
    Htac htac(config, size);
    const auto x = static_cast<std::uint16_t>(size.width_px - 1);
    const auto y = static_cast<std::uint16_t>(size.height_px - 1);
    htac.process(std::vector<core::Event>{{1us, x, y, true}, {1us, 0, y, false}});
    const Gray gray = picture_of(htac, 1us);
    EXPECT_EQ(gray(x, y), size.width_px == 1 ? gray_of(0) : gray_of(0.2)) << size.width_px;
    EXPECT_EQ(gray(0, y - 1), gray_of(0));
    EXPECT_EQ(gray(x, y - 1), gray_of(0));
  }
}

TEST(Htac, RefusesAConfigOutOfRange) {
  HtacConfig config;
  config.decay_time_s = 0;
  EXPECT_THROW(Htac(config, kSensor), std::invalid_argument);
}

}  // namespace
}  // namespace nightjar::esi
