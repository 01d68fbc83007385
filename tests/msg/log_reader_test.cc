#include "msg/log_reader.h"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "msg/log_writer.h"
#include "tests/support/scratch_folder.h"

namespace nightjar::msg {
namespace {

TEST(LogReader, ReadsWhatTheWriterWrote) {
  const test::ScratchFolder scratch;
  const std::vector<Message> sent = {{"FIRST", Bytes(16, 1)}, {"SECOND", Bytes(40, 2)}};
  LogWriter writer(scratch / "a.lcm");
  for (const Message& message : sent) writer.write(message.channel, message.bytes);
  writer.finish();
  LogReader reader(scratch / "a.lcm");
  EXPECT_EQ(reader.next(), sent[0]);
  EXPECT_GT(reader.progress(), 0);
  EXPECT_EQ(reader.next(), sent[1]);
  EXPECT_EQ(reader.progress(), 1);
  EXPECT_EQ(reader.next(), std::nullopt);
}

TEST(LogReader, KnowsALogByItsBeginning) {
  const test::ScratchFolder scratch;
  LogWriter writer(scratch / "a.lcm");
  writer.write("FIRST", Bytes(16));
  writer.finish();
  std::ofstream(scratch / "events.txt") << "0.1 2 3 1\n";
  std::ofstream(scratch / "empty");
  EXPECT_TRUE(is_log(scratch / "a.lcm"));
  for (const char* other : {"events.txt", "empty", "none"}) EXPECT_FALSE(is_log(scratch / other));
  EXPECT_THROW(LogReader(scratch / "none"), std::invalid_argument);
}

/// A log of three messages of 40 bytes on "CHANNEL": 28 + 7 + 40 bytes each.
std::string three_messages() {
  const test::ScratchFolder scratch;
  LogWriter writer(scratch / "a.lcm");
  for (const int i : {1, 2, 3}) writer.write("CHANNEL", Bytes(40, static_cast<std::uint8_t>(i)));
  writer.finish();
  return test::file_text(scratch / "a.lcm");
}
constexpr std::size_t kEach = 75;

/// The first byte of each message that is read, "123" for those above.
std::string read_all(const std::string& bytes, std::uint64_t expected_loss) {
  LogReader reader(std::make_unique<std::istringstream>(bytes), "a.lcm");
  std::string found;
  while (const auto message = reader.next()) found += static_cast<char>('0' + message->bytes.at(0));
  EXPECT_EQ(reader.bytes_lost(), expected_loss);
  EXPECT_EQ(reader.progress(), 1);
  EXPECT_EQ(reader.offset(), bytes.size());
  return found;
}

TEST(LogReader, SaysWhereAMessageBegins) {
  LogReader reader(std::make_unique<std::istringstream>(three_messages()), "a.lcm");
  for (std::uint64_t begin = 0; reader.next(); begin += kEach) EXPECT_EQ(reader.offset(), begin);
  reader.rewind();
  EXPECT_EQ(reader.next()->bytes, Bytes(40, 1));
  EXPECT_EQ(reader.offset(), 0u);
}

TEST(LogReader, GivesWhatIsWholeOfACutLog) {
  const std::string whole = three_messages();
  EXPECT_EQ(read_all(whole, 0), "123");
  EXPECT_EQ(read_all(whole.substr(0, 3 * kEach - 1), kEach - 1), "12");
  EXPECT_EQ(read_all(whole.substr(0, 2 * kEach + 3), 3), "12");
  EXPECT_EQ(read_all(whole.substr(5), kEach - 5), "23");
  EXPECT_EQ(read_all("", 0), "");
}

TEST(LogReader, GoesOnBehindWhatIsDamaged) {
  for (const std::size_t at : {0u, 3u, 20u, 23u, 24u, 25u, 27u}) {  // mark and lengths
    std::string bytes = three_messages();
    bytes[kEach + at] = static_cast<char>(bytes[kEach + at] ^ 0x41);
    // The first message's end is no longer told by a mark that is gone.
    const bool mark_is_gone = at < 4;
    EXPECT_EQ(read_all(bytes, (mark_is_gone ? 2 : 1) * kEach), mark_is_gone ? "3" : "13") << at;
  }
}

/// Counts how often it is asked for bytes or for a place.
class CountingBuffer : public std::stringbuf {
 public:
  using std::stringbuf::stringbuf;
  int calls = 0;

 private:
  std::streamsize xsgetn(char* to, std::streamsize count) override {
    ++calls;
    return std::stringbuf::xsgetn(to, count);
  }
  pos_type seekoff(off_type by, std::ios::seekdir from, std::ios::openmode which) override {
    ++calls;
    return std::stringbuf::seekoff(by, from, which);
  }
  pos_type seekpos(pos_type at, std::ios::openmode which) override {
    ++calls;
    return std::stringbuf::seekpos(at, which);
  }
};

TEST(LogReader, SearchesInBlocksForTheNextMessage) {
  CountingBuffer buffer(std::string(1 << 20, '\0') + three_messages());
  LogReader reader(std::make_unique<std::istream>(&buffer), "a.lcm");
  EXPECT_EQ(reader.next()->bytes, Bytes(40, 1));
  EXPECT_EQ(reader.bytes_lost(), 1u << 20);
  EXPECT_LT(buffer.calls, 100);  // a MiB is 16 blocks of 64 KiB: a place and a read of each
}

TEST(LogReader, FindsAMarkWhereverABlockEnds) {
  for (std::size_t lost = 65530; lost < 65541; ++lost)
    EXPECT_EQ(read_all(std::string(lost, '\xed') + three_messages(), lost), "123") << lost;
}

TEST(LogReader, TakesNoMessageAsLargeAsItsHeadMayClaim) {
  std::string bytes = three_messages();
  bytes.replace(24, 4, "\x7f\xff\xff\xff");  // 2 GiB of data
  EXPECT_EQ(read_all(bytes, kEach), "23");
  bytes.replace(20, 4, "\xff\xff\xff\xff");
  EXPECT_EQ(read_all(bytes, kEach), "23");
}

}  // namespace
}  // namespace nightjar::msg
