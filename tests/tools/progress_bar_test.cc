#include "tools/progress_bar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace nightjar::tools {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// A clock that stands still until it is told to move.
struct ProgressBarTest : testing::Test {
  ProgressBar::Clock clock = [this] { return now; };
  steady_clock::time_point now{};
  std::ostringstream out;
};

TEST_F(ProgressBarTest, WritesOneLinePerTenthWhereThereIsNoTerminal) {
  ProgressBar bar(out, false, clock);
  for (int step = 0; step <= 1000; ++step) bar.update(step * 0.01, 10.0, "track");
  const std::string text = out.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  EXPECT_EQ(text.find('\r'), std::string::npos);
  EXPECT_NE(text.find(" 30 %  3.0 of 10.0 s"), std::string::npos);
}

TEST_F(ProgressBarTest, ExpectsTheRestToGoAsFastAsBefore) {
  ProgressBar bar(out, false, clock);
  now += std::chrono::seconds(30);
  bar.update(2.5, 10.0, "track");  // a quarter in 30 s leaves 90 s
  EXPECT_EQ(out.str(), " 25 %  2.5 of 10.0 s  1:30 left  track\n");
}

TEST_F(ProgressBarTest, RedrawsATerminalsLineAtMostTenTimesASecondAndClearsIt) {
  {
    ProgressBar bar(out, true, clock);
    for (int step = 0; step < 100; ++step) {  // over one second
      bar.update(step, 100, "land");
      now += milliseconds(10);
    }
  }
  const std::string text = out.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\r'), 11);  // ten drawings, one clearing
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 0);
  EXPECT_TRUE(text.ends_with("\r\033[K"));
}

TEST_F(ProgressBarTest, TakesARunOfNoLengthAsDone) {
  ProgressBar bar(out, false, clock);
  bar.update(0, 0, "search");
  EXPECT_TRUE(out.str().starts_with("100 %"));
}

}  // namespace
}  // namespace nightjar::tools
