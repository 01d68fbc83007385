#include "esi/reconstructor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "esi/esi.h"
#include "tests/support/events.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSensor{16, 12};

/// Notes what reaches a method.
class Notes final : public Reconstructor {
 public:
  explicit Notes(core::Resolution size = kSensor) : Reconstructor(size) { reset(); }

  std::vector<PackedEvent> events;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> limits;  ///< now_us, most_us
  core::Time drawn_at{};
  core::Time start{};
  int frames = 0;

 private:
  void integrate(std::span<const PackedEvent> more) override {
    events.insert(events.end(), more.begin(), more.end());
  }
  void take_frame(core::ApsFrame&&) override { ++frames; }
  void draw(core::Time t, core::Image<std::uint8_t>&) override { drawn_at = t; }
  void clear(core::Time at) override { start = at; }
  void limit_ages(std::uint32_t now_us, std::uint32_t most_us) override {
    limits.emplace_back(now_us, most_us);
  }
};

std::vector<PackedEvent> packed(const std::vector<core::Event>& events) {
  std::vector<PackedEvent> all;
  for (const core::Event& e : events) all.push_back(pack(e, kSensor.width_px));
  return all;
}

std::string complaint(auto call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Reconstructor, RefusesASensorWithoutPixels) {
  EXPECT_THROW(Notes({0, 12}), std::invalid_argument);
  EXPECT_THROW(Notes({16, -1}), std::invalid_argument);
  EXPECT_THROW(Notes({core::kMostSide_px + 1, 1}), std::invalid_argument);
  EXPECT_NO_THROW(Notes({1, 1}));
}

TEST(Reconstructor, PacksEventsAndHandsThemOverInOrder) {
  const auto events = test::random_events(kSensor, 10000, 1s, /*seed=*/9);  // several blocks
  Notes notes;
  notes.process(events);
  EXPECT_EQ(notes.events, packed(events));
}

TEST(Reconstructor, PackedEventsReachTheMethodAsTheyAre) {
  const auto events = packed(test::random_events(kSensor, 10000, 1s, /*seed=*/9));
  Notes notes;
  notes.process(std::span<const PackedEvent>(events).first(5000));
  notes.process(std::span<const PackedEvent>(events).subspan(5000));
  EXPECT_EQ(notes.events, events);
  core::Picture picture;
  EXPECT_NO_THROW(notes.render(core::Time(events.back().t_us), picture));
  EXPECT_THROW(notes.render(core::Time(events.back().t_us - 1), picture), std::invalid_argument);
}

TEST(Reconstructor, NamesTheEventItRefusesAndKeepsThoseBefore) {
  for (const std::size_t place : {0, 1, 1023, 1024, 4095, 4096, 5000}) {
    auto events = test::random_events(kSensor, 6000, 1s, /*seed=*/10);
    const auto good = packed(events);
    events[place].x = 16;
    Notes full;
    EXPECT_EQ(complaint([&] { full.process(events); }),
              "event at (16, " + std::to_string(events[place].y) + "), allowed (0, 0) to (15, 11)");
    EXPECT_EQ(full.events, std::vector(good.begin(), good.begin() + static_cast<int>(place)));

    auto packed_events = good;
    packed_events[place].pixel_on = 2 * 16 * 12;  // the first beyond
    Notes from_packed;
    EXPECT_EQ(complaint([&] { from_packed.process(std::span<const PackedEvent>(packed_events)); }),
              "event at (0, 12), allowed (0, 0) to (15, 11)");
    EXPECT_EQ(from_packed.events, full.events);
  }
}

TEST(Reconstructor, RefusesAnEventOlderThanItsPredecessorOrTheStart) {
  Notes notes;
  notes.reset(5s);
  EXPECT_EQ(complaint([&] {
              notes.process(std::vector<core::Event>{{4s, 1, 1, true}});
            }),
            "event at 4000000 us, allowed from 5000000 us on");
  notes.process(std::vector<core::Event>{{6s, 1, 1, true}});
  EXPECT_EQ(complaint([&] {
              notes.process(packed({{5999999us, 1, 1, true}}));
            }),
            "event at 5999999 us, allowed from 6000000 us on");
  notes.process(std::vector<core::Event>{{6s, 1, 1, false}});  // the same time is allowed
  EXPECT_EQ(notes.events.size(), 2u);
}

TEST(Reconstructor, APackedStepOfMoreThanHalfTheRangeRunsBackwards) {
  Notes notes;
  EXPECT_NO_THROW(notes.process(std::vector<PackedEvent>{{0x7fffffffu, 1}}));
  EXPECT_THROW(notes.process(std::vector<PackedEvent>{{0xffffffffu, 1}}), std::invalid_argument);
}

TEST(Reconstructor, TimesOf32BitsWrapUnnoticed) {
  Notes notes;
  const core::Time wrap{std::int64_t{1} << 32};
  notes.reset(wrap - 1s);
  notes.process(std::vector<PackedEvent>{{low_us(wrap - 1ms), 1}, {low_us(wrap + 1ms), 1}});
  notes.process(std::vector<core::Event>{{wrap + 2ms, 1, 1, true}});
  EXPECT_EQ(notes.events.size(), 3u);
  core::Picture picture;
  EXPECT_THROW(notes.render(wrap + 1ms, picture), std::invalid_argument);
  notes.render(wrap + 2ms, picture);
  EXPECT_EQ(notes.drawn_at, wrap + 2ms);
}

TEST(Reconstructor, LimitsAgesOnceTheyMightBeAmbiguous) {
  constexpr core::Time kMost{Reconstructor::kMostAge_us};
  Notes notes;
  notes.process(std::vector<core::Event>{{kMost - 1us, 1, 1, true}});
  EXPECT_TRUE(notes.limits.empty());
  notes.process(std::vector<core::Event>{{kMost, 1, 1, true}});
  ASSERT_EQ(notes.limits.size(), 1u);
  EXPECT_EQ(notes.limits[0], std::pair(low_us(kMost), Reconstructor::kMostAge_us));
  // After a pause longer than the limit everything is just as old.
  notes.process(std::vector<core::Event>{{kMost + 100h, 1, 1, true}});
  ASSERT_EQ(notes.limits.size(), 2u);
  EXPECT_EQ(notes.limits[1], std::pair(low_us(100h), 0u));
}

TEST(Reconstructor, LimitsAgesAtTheSameEventsHoweverTheStreamIsCut) {
  std::vector<core::Event> events;
  for (int i = 0; i < 5000; ++i) events.push_back({i * 1s, 1, 1, true});
  Notes whole, single;
  whole.process(events);
  for (const core::Event& e : events) single.process({&e, 1});
  EXPECT_EQ(whole.limits.size(), 4u);  // 5000 s / 17.9 minutes
  EXPECT_EQ(whole.limits, single.limits);
  const auto all = packed(events);
  for (const std::size_t batch : {std::size_t{1}, std::size_t{700}, all.size()}) {
    Notes from_packed;
    for (std::size_t i = 0; i < all.size(); i += batch)
      from_packed.process(std::span(all).subspan(i, std::min(batch, all.size() - i)));
    EXPECT_EQ(from_packed.limits, single.limits) << batch;
  }
}

TEST(Reconstructor, LimitTimesMovesOnlyWhatIsOlder) {
  struct Cell {
    std::uint32_t t_us;
  };
  std::vector<Cell> cells = {{100}, {60}, {50}, {49}, {0}, {0xfffffff0u}};
  limit_times(cells, 100, 50);
  const std::uint32_t expected[] = {100, 60, 50, 50, 50, 50};
  for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_EQ(cells[i].t_us, expected[i]) << i;
}

TEST(Reconstructor, DrawsNoLaterThanTheLimitAfterTheLastEvent) {
  Notes notes;
  notes.process(std::vector<core::Event>{{1s, 1, 1, true}});
  core::Picture picture;
  notes.render(30h, picture);
  EXPECT_EQ(picture.t, 30h);
  EXPECT_EQ(notes.drawn_at, 1s + core::Time(Reconstructor::kMostAge_us));
}

TEST(Reconstructor, GivesThePictureTheSensorsSize) {
  Notes notes;
  core::Picture picture;
  picture.gray = core::Image<std::uint8_t>({3, 3});
  notes.render(0s, picture);
  EXPECT_EQ(picture.gray.size(), kSensor);
}

/// What ESI makes of one ON event, `age` after the start or the event before.
int gray_after(Esi& esi, core::Time t) {
  esi.process(std::vector<core::Event>{{t, 1, 1, true}});
  core::Picture picture;
  esi.render(t, picture);
  return picture.gray(1, 1);
}

TEST(Reconstructor, RefusesTimesThatWouldOverflow) {
  constexpr core::Time kFarthest{Reconstructor::kFarthest_us};
  Notes notes;
  core::Picture picture;
  core::ApsFrame frame{1us, 2us, 8, core::Image<std::uint16_t>(kSensor)};
  for (const core::Time t : {kFarthest + 1us, core::Time::max()}) {
    const std::string allowed = " at " + std::to_string(t.count()) + " us, allowed -23058430092";
    EXPECT_NE(complaint([&] {
                notes.process(std::vector<core::Event>{{t, 1, 1, true}});
              }).find("event" + allowed),
              std::string::npos);
    EXPECT_NE(complaint([&] { notes.render(t, picture); }).find("picture" + allowed),
              std::string::npos);
    EXPECT_NE(complaint([&] { notes.reset(t); }).find("start" + allowed), std::string::npos);
    EXPECT_THROW(notes.reset(-t), std::invalid_argument);
    frame.exposure_end = t;
    EXPECT_NE(complaint([&] { notes.add_frame(frame); }).find("frame" + allowed),
              std::string::npos);
  }
  EXPECT_TRUE(notes.events.empty());
  notes.reset(-kFarthest);
  notes.process(std::vector<core::Event>{{kFarthest, 1, 1, true}});
  EXPECT_EQ(notes.events.size(), 1u);
}

TEST(Reconstructor, UnixTimesWorkOnceItIsResetToTheirBegin) {
  const core::Time begin = 1'700'000'000s;
  Esi near_zero({}, kSensor), unix_time({}, kSensor);
  unix_time.reset(begin);
  for (const core::Time t : {1ms, 300ms, 700ms, 3000ms, 3001ms})
    EXPECT_EQ(gray_after(unix_time, begin + t), gray_after(near_zero, t)) << t.count();
}

TEST(Reconstructor, AnIntervalOfAWholeWrapIsNoShortOne) {
  // Kept modulo 2^32 us alone, an event 71.6 minutes later would seem to follow at once.
  const core::Time wrap{std::int64_t{1} << 32};
  for (const core::Time pause : {wrap, wrap + 1ms, 3 * wrap + 1ms, wrap / 2, wrap / 4}) {
    Esi esi({}, kSensor);
    EXPECT_GT(gray_after(esi, 1ms), 128);
    EXPECT_EQ(gray_after(esi, 1ms + pause), 128) << pause.count();  // all gone, itself too
  }
}

TEST(Reconstructor, APixelLongSilentIsForgottenWhileOthersGoOn) {
  const core::Time wrap{std::int64_t{1} << 32};
  Esi esi({}, kSensor);
  EXPECT_GT(gray_after(esi, 1ms), 128);
  for (core::Time t = 1min; t < wrap; t += 1min)
    esi.process(std::vector<core::Event>{{t, 2, 2, true}});
  EXPECT_EQ(gray_after(esi, wrap + 2ms), 128);
}

}  // namespace
}  // namespace nightjar::esi
