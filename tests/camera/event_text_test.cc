#include "camera/event_text.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "core/random.h"
#include "tests/support/data_folder.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::camera {
namespace {

using core::Event;
using core::Time;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr core::Resolution kDavis346{346, 260};

EventRecording parse(const std::string& text, std::optional<core::Resolution> size = std::nullopt) {
  std::istringstream in(text);
  return read_event_text(in, "dark.txt", size);
}

std::string error_of(const std::string& text, core::Resolution size = kDavis346) {
  try {
    parse(text, size);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

Time time_of(const std::string& seconds) { return parse(seconds + " 0 0 1\n").events.at(0).t; }

TEST(EventTextReaderTest, reads_one_event_a_line) {
  const EventRecording recording = parse("0.000011 158 145 1\n0.000050 88 143 0\n");
  EXPECT_THAT(recording.events,
              ElementsAre(Event{Time(11), 158, 145, true}, Event{Time(50), 88, 143, false}));
}

TEST(EventTextReaderTest, takes_the_comments_blank_lines_line_ends_and_spaces_people_write) {
  const EventRecording recording = parse(
      "#!events.txt\r\n# t x y polarity\r\n\r\n  \t\n0.5 1 2 -1\r\n \t0.5\t 3  4\t1 \n"
      "   # a comment set in\n0.75 5 6 0");
  EXPECT_THAT(recording.events,
              ElementsAre(Event{Time(500000), 1, 2, false}, Event{Time(500000), 3, 4, true},
                          Event{Time(750000), 5, 6, false}));
}

TEST(EventTextReaderTest, keeps_times_to_the_nearest_microsecond_however_they_are_written) {
  EXPECT_EQ(time_of("13.582595999"), Time(13582596));        // RPG: nanoseconds, cut off
  EXPECT_EQ(time_of("13.582596999000002"), Time(13582597));  // RPG: printed from a double
  EXPECT_EQ(time_of("0.6367649989999999"), Time(636765));
  EXPECT_EQ(time_of("5e-05"), Time(50));  // v2e: as Python prints small numbers
  EXPECT_EQ(time_of("1.25E-4"), Time(125));
  EXPECT_EQ(time_of("1.5e+2"), Time(150'000'000));
  EXPECT_EQ(time_of("4e-7"), Time(0));
  EXPECT_EQ(time_of("5e-7"), Time(1));
  EXPECT_EQ(time_of("9e-9"), Time(0));
  EXPECT_EQ(time_of("7"), Time(7'000'000));
  EXPECT_EQ(time_of("7."), Time(7'000'000));
  EXPECT_EQ(time_of(".25"), Time(250'000));
  EXPECT_EQ(time_of("000.1"), Time(100'000));
}

TEST(EventTextReaderTest, keeps_unix_times_exact_to_the_microsecond) {
  EXPECT_EQ(time_of("1589163147.368868"), Time(1589163147368868));
  // Beyond 2^53 us, where a double holds even microseconds only.
  EXPECT_EQ(time_of("99999999999.999999"), Time(99999999999999999));
}

TEST(EventTextReaderTest, deduces_the_smallest_sensor_that_holds_the_events) {
  EXPECT_EQ(parse("0 3 9 1\n1 239 0 1\n").size, (core::Resolution{240, 10}));
  EXPECT_EQ(parse("# nothing happened\n").size, (core::Resolution{0, 0}));
}

TEST(EventTextReaderTest, takes_the_sensor_it_is_told) {
  EXPECT_EQ(parse("0 3 9 1\n", kDavis346).size, kDavis346);
  EXPECT_EQ(parse("", kDavis346).size, kDavis346);
}

TEST(EventTextReaderTest, says_what_is_wrong_and_on_which_line) {
  EXPECT_EQ(error_of("#\n\n0.1 400 2 1\n"), "dark.txt:3: x = 400, allowed 0 to 345");
  EXPECT_EQ(error_of("0.1 2 260 1\n"), "dark.txt:1: y = 260, allowed 0 to 259");
  EXPECT_EQ(error_of("0.1 -1 2 1\n"), "dark.txt:1: x = -1, allowed 0 to 345");
  EXPECT_EQ(error_of("0.1 1.5 2 1\n"), "dark.txt:1: x = 1.5, allowed 0 to 345");
  EXPECT_EQ(error_of("0.1 99999999999 2 1\n"), "dark.txt:1: x = 99999999999, allowed 0 to 345");
  EXPECT_EQ(error_of("0.1 1 2 2\n"), "dark.txt:1: polarity = 2, allowed 1, 0 or -1");
  EXPECT_EQ(error_of("0.1 1 2 nan\n"), "dark.txt:1: polarity = nan, allowed 1, 0 or -1");
  EXPECT_EQ(error_of("0.1 1 2\n"), "dark.txt:1: no polarity, expected: t_seconds x y polarity");
  EXPECT_EQ(error_of("0.1\n"), "dark.txt:1: no x, expected: t_seconds x y polarity");
  EXPECT_EQ(error_of("0.1 1 2 1 7\n"), "dark.txt:1: '7' after the polarity");
  EXPECT_EQ(error_of("0.2 1 2 1\n0.1 1 2 1\n"),
            "dark.txt:2: t_seconds = 0.100000, allowed 0.200000 or later");
}

TEST(EventTextReaderTest, takes_nothing_but_plain_seconds_for_a_time) {
  for (const char* seconds :
       {"nan", "inf", "-0.1", "+1", "1e", "1e99", "1e2147483648", "1e+-3", "1e1.5", "0x10", ".",
        "e5", "1.2.3", "1,5", "1000000000000", "99999999999999999999999999", "0936132303163832"})
    EXPECT_EQ(error_of(std::string(seconds) + " 1 2 1\n"),
              fmt::format("dark.txt:1: t_seconds = {}, allowed 0 to 999999999999", seconds));
}

TEST(EventTextReaderTest, shows_odd_bytes_and_long_words_as_one_short_line) {
  EXPECT_EQ(error_of("0.1 \x01\xff 2 1\n"), "dark.txt:1: x = ??, allowed 0 to 345");
  EXPECT_EQ(error_of(std::string(1000, 'a') + " 1 2 1"),
            "dark.txt:1: t_seconds = " + std::string(40, 'a') + "..., allowed 0 to 999999999999");
}

TEST(EventTextReaderTest, bounds_a_sensor_it_has_to_deduce) {
  EXPECT_EQ(parse("0 32766 32766 1\n").size, (core::Resolution{32767, 32767}));
  EXPECT_THROW(parse("0 32767 0 1\n"), std::invalid_argument);
}

TEST(EventTextReaderTest, refuses_a_sensor_that_is_none) {
  EXPECT_THROW(parse("", core::Resolution{0, 260}), std::invalid_argument);
  EXPECT_THROW(parse("", core::Resolution{346, 32768}), std::invalid_argument);
}

TEST(EventTextReaderTest, names_a_file_that_cannot_be_read) {
  const test::ScratchFolder folder;
  EXPECT_THAT(
      [&] { read_event_text(folder / "none.txt"); },
      testing::ThrowsMessage<std::invalid_argument>(testing::EndsWith("none.txt: cannot be read")));
  EXPECT_THROW(read_event_text(folder.path()), std::invalid_argument);
}

std::vector<Event> random_events(int count) {
  core::Random random = core::random_stream(3, "event_text_test");
  std::vector<Event> events;
  Time t{};
  for (int i = 0; i < count; ++i) {
    t += Time(static_cast<std::int64_t>(core::exponential(random) * 1e6));
    events.push_back({t, static_cast<std::uint16_t>(random() % 346),
                      static_cast<std::uint16_t>(random() % 260), random() % 2 == 0});
  }
  return events;
}

TEST(EventTextWriterTest, writes_what_the_reader_reads_back_bit_for_bit) {
  const test::ScratchFolder folder;
  std::vector<Event> events = random_events(10000);
  for (Event& event : events) event.t += Time(1589163147368868);  // Unix time
  EventTextWriter writer(folder / "events.txt");
  writer.write(std::span(events).first(4000));
  writer.write({});
  writer.write(std::span(events).subspan(4000));
  writer.finish();
  const EventRecording recording = read_event_text(folder / "events.txt", kDavis346);
  EXPECT_TRUE(recording.events == events);
}

TEST(EventTextWriterTest, writes_the_columns_of_the_rpg_files) {
  const test::ScratchFolder folder;
  EventTextWriter writer(folder / "events.txt");
  writer.write(std::vector<Event>{{Time(0), 1, 2, true}, {Time(1234000007), 3, 4, false}});
  writer.finish();
  EXPECT_EQ(test::file_text(folder / "events.txt"), "0.000000 1 2 1\n1234.000007 3 4 0\n");
}

TEST(EventTextWriterTest, leaves_nothing_behind_unless_it_is_finished) {
  const test::ScratchFolder folder;
  {
    EventTextWriter writer(folder / "events.txt");
    writer.write(random_events(100));
    EXPECT_FALSE(std::filesystem::exists(folder / "events.txt"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(EventTextWriterTest, keeps_an_older_file_until_the_new_one_is_finished) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "events.txt") << "old";
  { EventTextWriter writer(folder / "events.txt"); }
  EXPECT_EQ(test::file_text(folder / "events.txt"), "old");
  EventTextWriter writer(folder / "events.txt");
  writer.finish();
  EXPECT_EQ(test::file_text(folder / "events.txt"), "");
}

TEST(EventTextWriterTest, refuses_events_that_could_not_be_read_back) {
  const test::ScratchFolder folder;
  const Event first{Time(5), 1, 1, true};
  for (const Event& bad : {Event{Time(4), 1, 1, true}, Event{Time(5), 32767, 1, true},
                           Event{Time(5), 1, 32767, true}, Event{Time::max(), 1, 1, true}}) {
    EventTextWriter writer(folder / "events.txt");
    writer.write({&first, 1});
    EXPECT_THROW(writer.write({&bad, 1}), std::invalid_argument);
  }
  const Event before_zero{Time(-1), 1, 1, true};
  EventTextWriter writer(folder / "events.txt");
  EXPECT_THROW(writer.write({&before_zero, 1}), std::invalid_argument);
}

TEST(EventTextWriterTest, names_a_place_where_nothing_can_be_written) {
  const test::ScratchFolder folder;
  EXPECT_THAT([&] { EventTextWriter writer(folder / "none/events.txt"); },
              testing::ThrowsMessage<std::invalid_argument>(testing::EndsWith(
                  "none/events.txt: cannot be written, No such file or directory")));
  EXPECT_THROW(EventTextWriter writer(folder.path()), std::invalid_argument);
  EXPECT_THROW(EventTextWriter writer("/dev/null"), std::invalid_argument);
}

/// What is known of a real recording.
struct Known {
  const char* file;
  std::size_t events;
  std::size_t on;
  Time first, last;
};

class RealEventTextTest : public testing::TestWithParam<Known> {};

// Counted with awk, and the times read by eye, from the files of the RPG data set.
INSTANTIATE_TEST_SUITE_P(
    Davis240c, RealEventTextTest,
    testing::Values(
        Known{"davis240c_boxes_rotation.txt", 30000, 13540, Time(13582596), Time(13595875)},
        Known{"davis240c_dynamic_rotation.txt", 30000, 12912, Time(19098314), Time(19119366)},
        Known{"davis240c_poster_rotation.txt", 30000, 13243, Time(636764), Time(660949)},
        Known{"davis240c_shapes_rotation.txt", 20000, 8560, Time(2097134), Time(2195729)},
        Known{"davis240c_slider_depth.txt", 50000, 21147, Time(3811), Time(174156)}),
    [](const auto& instance) {
      const std::string file = instance.param.file;
      return file.substr(0, file.find('.'));
    });

TEST_P(RealEventTextTest, reads_every_event_of_a_real_recording) {
  const auto folder = test::data_folder();
  if (!folder) GTEST_SKIP() << "no folder of recordings: set NIGHTJAR_DATA";
  const EventRecording recording =
      read_event_text(*folder / GetParam().file, core::Resolution{240, 180});
  ASSERT_EQ(recording.events.size(), GetParam().events);
  EXPECT_EQ(std::ranges::count_if(recording.events, &Event::on), GetParam().on);
  EXPECT_EQ(recording.events.front().t, GetParam().first);
  EXPECT_EQ(recording.events.back().t, GetParam().last);
}

TEST(EventTextReaderTest, deduces_the_sensor_of_a_real_recording) {
  const auto folder = test::data_folder();
  if (!folder) GTEST_SKIP() << "no folder of recordings: set NIGHTJAR_DATA";
  EXPECT_EQ(read_event_text(*folder / "davis240c_slider_depth.txt").size,
            (core::Resolution{240, 180}));
}

}  // namespace
}  // namespace nightjar::camera
