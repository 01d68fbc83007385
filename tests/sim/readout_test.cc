#include "sim/readout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "core/random.h"
#include "tests/support/events.h"

namespace nightjar::sim {
namespace {

using core::Event;
using core::Time;

constexpr core::Resolution kSize{346, 260};

Event event(int t_us, int x, int y) {
  return {Time(t_us), static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), true};
}

/// A burst of the first `n` pixels, row by row, all at `t_us`.
std::vector<Event> burst(int t_us, int n) {
  std::vector<Event> events;
  for (int i = 0; i < n; ++i) events.push_back(event(t_us, i % 346, i / 346));
  return events;
}

bool ordered(const std::vector<Event>& events) {
  return std::ranges::is_sorted(events, {}, &Event::t);
}

/// The arbiter as it is described: a queue for each row, one event after the other.
class PlainReadout {
 public:
  explicit PlainReadout(const ReadoutConfig& config)
      : capacity_(config.queue_capacity_events),
        service_ps_(std::llround(1e12 / config.max_event_rate_hz)),
        rows_(kSize.height_px) {}

  void step(Time until, std::span<const Event> requests, std::vector<Event>& events) {
    for (;;) {
      if (waiting == 0) {
        if (requests.empty()) return;
        free_ps_ = std::max(free_ps_, requests.front().t.count() * 1'000'000);
      }
      for (; !requests.empty() && requests.front().t.count() * 1'000'000 <= free_ps_;
           requests = requests.subspan(1))
        admit(requests.front());
      const Time now(free_ps_ / 1'000'000);
      if (now > until) return;
      const Event request = take_next();
      max_delay = std::max(max_delay, now - request.t);
      events.push_back({now, request.x, request.y, request.on});
      free_ps_ += service_ps_;
    }
  }

  int waiting = 0;
  std::uint64_t lost = 0;
  Time max_delay{};

 private:
  void admit(const Event& request) {
    if (waiting >= capacity_) {
      ++lost;
      return;
    }
    if (rows_[request.y].empty()) asking_.push_back(request.y);
    rows_[request.y].push_back(request);
    ++waiting;
  }

  Event take_next() {
    std::deque<Event>& row = rows_[asking_.front()];
    if (turn_left_ == 0) turn_left_ = row.size();
    const Event request = row.front();
    row.pop_front();
    --waiting;
    if (--turn_left_ > 0) return request;
    if (!row.empty()) asking_.push_back(asking_.front());
    asking_.pop_front();
    return request;
  }

  int capacity_;
  std::int64_t service_ps_, free_ps_ = 0;
  std::size_t turn_left_ = 0;
  std::deque<std::uint16_t> asking_;
  std::vector<std::deque<Event>> rows_;
};

/// Requests of (begin, end] in bursts, so that the readout idles, queues and overflows.
/// Ordered by time, and in the same microsecond by row if `by_row`.
std::vector<Event> bursts(Time begin, Time end, bool by_row, core::Random& random) {
  std::vector<Event> requests;
  for (Time t = begin + Time(1); t <= end; t += Time(1 + random() % 40)) {
    const auto size = static_cast<int>(random() % (random() % 8 == 0 ? 120 : 12));
    const auto spread_us = 1 + random() % 6;
    for (int i = 0; i < size; ++i)
      requests.push_back({std::min(end, t + Time(random() % spread_us)),
                          static_cast<std::uint16_t>(random() % 346),
                          static_cast<std::uint16_t>(random() % 5), random() % 2 == 0});
  }
  std::ranges::stable_sort(requests, [&](const Event& a, const Event& b) {
    return a.t != b.t ? a.t < b.t : by_row && a.y < b.y;
  });
  return requests;
}

TEST(Readout, does_what_a_queue_for_each_row_does) {
  core::Random random = core::random_stream(3, "readout");
  for (const double rate_hz : {1e6, 12e6, 1e9})
    for (const int capacity : {1, 30, 12'000})
      for (const bool by_row : {true, false}) {
        const ReadoutConfig config{.max_event_rate_hz = rate_hz, .queue_capacity_events = capacity};
        Readout readout(config, kSize);
        PlainReadout plain(config);
        std::vector<Event> events, expected;
        Time begin{};
        for (int step = 0; step < 200; ++step) {
          const Time end = begin + Time(1 + random() % 300);
          const std::vector<Event> requests = bursts(begin, end, by_row, random);
          readout.step(end, requests, events);
          plain.step(end, requests, expected);
          ASSERT_EQ(events, expected) << rate_hz << ' ' << capacity << ' ' << by_row;
          ASSERT_EQ(readout.waiting(), plain.waiting);
          begin = end;
        }
        EXPECT_EQ(readout.counts().read, expected.size());
        EXPECT_EQ(readout.counts().lost, plain.lost);
        EXPECT_EQ(readout.counts().max_delay, plain.max_delay);
      }
}

TEST(Readout, an_idle_readout_changes_nothing) {
  // 10 us apart, far slower than 12 to the microsecond.
  const std::vector<Event> requests = test::random_events(kSize, 500, Time(10'000), 1);
  Readout readout({}, kSize);
  std::vector<Event> events;
  readout.step(Time(10'000), requests, events);
  EXPECT_EQ(events, requests);
  EXPECT_EQ(readout.counts().lost, 0u);
  EXPECT_EQ(readout.counts().max_delay, Time(0));
}

TEST(Readout, ten_thousand_at_once_take_most_of_a_millisecond) {
  Readout readout({}, kSize);
  std::vector<Event> events;
  readout.step(Time(5'000), burst(1'000, 10'000), events);
  ASSERT_EQ(events.size(), 10'000u);
  EXPECT_TRUE(ordered(events));
  // The last one waits for 9,999 others at 12 to the microsecond.
  EXPECT_EQ(events.back().t, Time(1'833));
  EXPECT_EQ(readout.counts().max_delay, Time(833));
  for (std::size_t i = 0; i < events.size(); i += 100)
    EXPECT_NEAR(static_cast<double>(events[i].t.count()), 1'000 + static_cast<double>(i) / 12, 1)
        << "rounded to a whole microsecond";
}

TEST(Readout, what_the_queue_cannot_hold_is_lost_and_counted) {
  ReadoutConfig config;
  config.queue_capacity_events = 4'000;
  Readout readout(config, kSize);
  std::vector<Event> events;
  readout.step(Time(5'000), burst(1'000, 10'000), events);
  EXPECT_EQ(events.size(), 4'000u);
  EXPECT_EQ(readout.counts().read, 4'000u);
  EXPECT_EQ(readout.counts().lost, 6'000u);
  // With the queue drained there is room again.
  readout.step(Time(9'000), burst(6'000, 3'000), events);
  EXPECT_EQ(events.size(), 7'000u);
  EXPECT_EQ(readout.counts().lost, 6'000u);
}

TEST(Readout, rows_take_turns_in_the_order_they_asked) {
  // One event a microsecond. Row 7 asks first; while it is read, rows 2 and 7 ask:
  // row 2 comes before the rest of row 7.
  ReadoutConfig config;
  config.max_event_rate_hz = 1e6;
  Readout readout(config, kSize);
  std::vector<Event> events;
  const std::vector<Event> requests{event(10, 5, 7), event(10, 3, 7), event(10, 9, 7),
                                    event(11, 0, 2), event(11, 8, 7), event(12, 1, 2)};
  readout.step(Time(100), requests, events);
  const std::vector<Event> expected{event(10, 5, 7), event(11, 3, 7), event(12, 9, 7),
                                    event(13, 0, 2), event(14, 1, 2), event(15, 8, 7)};
  EXPECT_EQ(events, expected);
}

TEST(Readout, the_rest_comes_with_the_next_call) {
  Readout at_once({}, kSize), in_pieces({}, kSize);
  std::vector<Event> whole, pieces;
  std::vector<Event> requests = burst(1'000, 9'000);
  const std::vector<Event> second = burst(1'200, 5'000);
  at_once.step(Time(1'000), requests, whole);
  at_once.step(Time(4'000), second, whole);
  in_pieces.step(Time(1'000), requests, pieces);
  for (int t = 1'001; t <= 4'000; ++t) {
    const std::size_t before = pieces.size();
    in_pieces.step(Time(t), t == 1'200 ? second : std::vector<Event>{}, pieces);
    for (std::size_t i = before; i < pieces.size(); ++i) EXPECT_EQ(pieces[i].t, Time(t));
  }
  EXPECT_EQ(whole, pieces);
  EXPECT_EQ(whole.size() + at_once.counts().lost, 14'000u);
  EXPECT_TRUE(ordered(whole));
  EXPECT_EQ(in_pieces.waiting(), 0);
}

TEST(Readout, never_puts_out_more_than_its_rate) {
  ReadoutConfig config;
  config.max_event_rate_hz = 2e6;
  Readout readout(config, kSize);
  std::vector<Event> events;
  // 4 million a second for 10 ms.
  const std::vector<Event> requests = test::random_events(kSize, 9'000, Time(30'000), 2);
  std::vector<Event> squeezed = requests;
  for (Event& e : squeezed) e.t = Time(e.t.count() / 12);
  readout.step(Time(20'000), squeezed, events);
  EXPECT_TRUE(ordered(events));
  for (std::size_t i = 200; i < events.size(); ++i)
    EXPECT_GE((events[i].t - events[i - 200].t).count(), 99);  // 200 events: 100 us
  EXPECT_EQ(readout.counts().read + readout.counts().lost, squeezed.size());
}

TEST(Readout, wrong_requests_are_refused_and_leave_no_trace) {
  Readout readout({}, kSize);
  std::vector<Event> events;
  readout.step(Time(100), std::vector{event(50, 1, 1)}, events);
  EXPECT_THROW(readout.step(Time(200), std::vector{event(90, 1, 1)}, events),
               std::invalid_argument);
  EXPECT_THROW(readout.step(Time(200), std::vector{event(201, 1, 1)}, events),
               std::invalid_argument);
  EXPECT_THROW(readout.step(Time(200), std::vector{event(150, 1, 1), event(149, 1, 1)}, events),
               std::invalid_argument);
  EXPECT_THROW(readout.step(Time(200), std::vector{event(150, 346, 1)}, events),
               std::invalid_argument);
  EXPECT_THROW(readout.step(Time(200), std::vector{event(150, 1, 260)}, events),
               std::invalid_argument);
  readout.step(Time(200), std::vector{event(101, 2, 2)}, events);
  EXPECT_EQ(events.size(), 2u);
}

}  // namespace
}  // namespace nightjar::sim
