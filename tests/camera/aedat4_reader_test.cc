#include "camera/aedat4_reader.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "camera/recording_writer.h"
#include "tests/support/data_folder.h"
#include "tests/support/recording_samples.h"
#include "tests/support/recordings.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::camera {
namespace {

using core::Event;
using core::Time;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr core::Resolution kSize{37, 23};

// Files are made by our own writer, which tests/support/read_recording.py checks independently,
// and then spoilt.
class Aedat4ReaderTest : public testing::Test {
 protected:
  std::string file_of(const std::vector<RecordingPart>& parts,
                      Compression compression = Compression::none) {
    const auto writer = create_recording(folder_ / "a.aedat4", {kSize, "DAVIS"}, compression);
    for (const RecordingPart& part : parts) writer->write(part);
    writer->finish();
    return test::file_text(folder_ / "a.aedat4");
  }

  static RecordingPart events_at(std::vector<std::int64_t> times_us) {
    RecordingPart part;
    for (const std::int64_t t : times_us) part.events.push_back({Time(t), 1, 2, true});
    return part;
  }

  std::size_t header_size() { return file_of({}).size(); }

  static std::string packet(std::int32_t stream, const std::string& content) {
    const std::int32_t header[] = {stream, static_cast<std::int32_t>(content.size())};
    return std::string(reinterpret_cast<const char*>(header), sizeof(header)) + content;
  }

  static std::string error_of(const std::string& bytes,
                              std::optional<core::Resolution> size = std::nullopt) {
    try {
      test::read_bytes(bytes, size);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "no error";
  }

  test::ScratchFolder folder_;
};

std::vector<std::int64_t> times_of(const test::WholeRecording& recording) {
  std::vector<std::int64_t> times;
  for (const Event& event : recording.all.events) times.push_back(event.t.count());
  return times;
}

TEST_F(Aedat4ReaderTest, delivers_what_is_whole_wherever_the_file_is_cut) {
  const std::string whole = file_of({events_at({1, 2}), events_at({3, 4})});
  const std::size_t header = header_size(), second = header + (whole.size() - header) / 2;
  for (std::size_t cut = header; cut < whole.size(); ++cut) {
    const test::WholeRecording read = test::read_bytes(whole.substr(0, cut));
    EXPECT_EQ(times_of(read).size(), cut < second ? 0u : 2u) << cut;
    const std::size_t begin = cut < second ? header : second;
    EXPECT_EQ(read.faults.bytes_lost, cut - begin) << cut;
    if (cut > begin) {
      EXPECT_THAT(read.faults.first, StartsWith(fmt::format("dark.rec: byte {}: ", begin)));
    }
  }
}

TEST_F(Aedat4ReaderTest, refuses_a_header_that_is_cut_and_says_where) {
  const std::string whole = file_of({});
  for (std::size_t cut = 12; cut < whole.size(); ++cut)
    EXPECT_THAT(error_of(whole.substr(0, cut)), StartsWith("dark.rec: byte ")) << cut;
}

TEST_F(Aedat4ReaderTest, passes_over_damaged_and_unknown_packets) {
  std::string strange(24, '\0');
  strange[0] = 20;
  std::memcpy(strange.data() + 8, "ZZZZ", 4);
  const std::string good = file_of({events_at({1})});
  const std::string bytes =
      good + packet(0, "garbage") + packet(9, strange) + good.substr(header_size());
  const test::WholeRecording read = test::read_bytes(bytes);
  EXPECT_THAT(times_of(read), ElementsAre(1, 1));
  EXPECT_EQ(read.faults.packets_damaged, 1u);
  EXPECT_EQ(read.faults.packets_unknown, 1u);
  EXPECT_EQ(read.faults.bytes_lost, 0u);
  EXPECT_THAT(read.faults.first, StartsWith(fmt::format("dark.rec: byte {}: packet", good.size())));
}

TEST_F(Aedat4ReaderTest, reads_the_first_stream_of_a_kind_alone) {
  const std::string good = file_of({events_at({1})});
  std::string other = good.substr(header_size());
  other[0] = 7;  // its stream
  const test::WholeRecording read = test::read_bytes(good + other);
  EXPECT_THAT(times_of(read), ElementsAre(1));
  EXPECT_EQ(read.faults.packets_unknown, 1u);
}

TEST_F(Aedat4ReaderTest, stops_at_a_size_that_cannot_be) {
  for (const std::int32_t size : {-1, 1 << 30}) {
    std::string bytes = file_of({events_at({1})}) + packet(0, "") + "tail";
    std::memcpy(bytes.data() + bytes.size() - 8, &size, 4);
    const test::WholeRecording read = test::read_bytes(bytes);
    EXPECT_THAT(times_of(read), ElementsAre(1));
    EXPECT_EQ(read.faults.bytes_lost, 12u);
  }
}

TEST_F(Aedat4ReaderTest, survives_every_single_spoilt_byte) {
  for (const Compression compression : {Compression::none, Compression::lz4, Compression::zstd}) {
    RecordingPart part = events_at({1, 2, 3});
    part.imu.emplace_back();
    part.triggers = {{Time(5), 2}};
    const std::string good = file_of({part}, compression);
    for (std::size_t i = 0; i < good.size(); ++i) {
      std::string bad = good;
      bad[i] = static_cast<char>(bad[i] ^ 0xff);
      error_of(bad);  // it throws nothing but std::invalid_argument
    }
  }
}

TEST_F(Aedat4ReaderTest, refuses_a_packet_that_unpacks_to_more_than_it_may) {
  for (const Compression compression : {Compression::lz4, Compression::zstd}) {
    const std::vector<std::byte> zeros(kMostPacketBytes + 1);
    const std::vector<std::byte> bomb = compress(zeros, compression);
    ASSERT_LT(bomb.size(), zeros.size() / 100);
    const std::string bytes =
        file_of({}, compression) +
        packet(0, std::string(reinterpret_cast<const char*>(bomb.data()), bomb.size()));
    const test::WholeRecording read = test::read_bytes(bytes);
    EXPECT_EQ(read.faults.packets_damaged, 1u);
    EXPECT_THAT(read.faults.first, HasSubstr("more than 67108864 bytes"));
  }
}

TEST_F(Aedat4ReaderTest, drops_and_counts_events_that_are_off_the_sensor_or_late) {
  RecordingPart part = events_at({10, 20, 30});
  const std::string good = file_of({part});
  std::string bytes = good;
  const std::size_t last = bytes.size() - 16;
  bytes[last] = 19;           // the third's time: before the second's
  bytes[last - 16 + 8] = 37;  // the second's x
  const test::WholeRecording read = test::read_bytes(bytes);
  EXPECT_THAT(times_of(read), ElementsAre(10, 19));
  EXPECT_EQ(read.faults.events_outside, 1u);
  bytes[last] = 9;
  EXPECT_EQ(test::read_bytes(bytes).faults.events_backwards, 1u);
}

TEST_F(Aedat4ReaderTest, checks_a_size_it_is_told) {
  EXPECT_THAT(error_of(file_of({}), core::Resolution{346, 260}),
              "dark.rec: byte 14: the header says 37x23 px, expected 346x260");
}

TEST_F(Aedat4ReaderTest, takes_nothing_for_an_event_beyond_the_table_of_packets) {
  const auto folder = test::data_folder();
  if (!folder) GTEST_SKIP() << "no folder of recordings: set NIGHTJAR_DATA";
  std::string bytes = test::file_text(*folder / "davis346_road.aedat4");
  // The table is the last kilobytes; without it the recording is complete, and says so.
  bytes.resize(428314);
  const test::WholeRecording read = test::read_bytes(bytes);
  EXPECT_EQ(read.all.events.size(), 6676u);
  EXPECT_FALSE(read.faults.any()) << read.faults.first;
}

}  // namespace
}  // namespace nightjar::camera
