#include "msg/log_reader.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

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

}  // namespace
}  // namespace nightjar::msg
