#include "msg/step_mark.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "msg/convert.h"

namespace nightjar::msg {
namespace {

using namespace std::chrono_literals;

StepMark some_mark() {
  return {.t = 10ms,
          .run = -5,
          .sequence = 1LL << 40,
          .origin = 7us,
          .lock_step = true,
          .sent = {{"A", 1}, {"", 0}, {"NIGHTJAR_EVENT_PARTS", 12}},
          .sender = "source"};
}

TEST(StepMark, TravelsWithoutALoss) {
  EXPECT_EQ(decode<StepMark>(encode(some_mark())), some_mark());
  EXPECT_EQ(decode<StepMark>(encode(StepMark{})), StepMark{});
  EXPECT_EQ(message_time(encode(some_mark())), 10ms);
}

TEST(StepMark, RefusesACountThatTheMessageCannotHold) {
  Bytes bytes = encode(some_mark());
  bytes[8 + 4 * 8 + 1] = 0x7f;  // the count's first byte
  EXPECT_THROW(decode<StepMark>(bytes), std::invalid_argument);
  const Bytes whole = encode(some_mark());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(decode<StepMark>(std::span(whole).first(size)), std::invalid_argument) << size;
}

}  // namespace
}  // namespace nightjar::msg
