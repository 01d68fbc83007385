#include "scenarios/video_panes.h"

#include <gtest/gtest.h>

namespace nightjar::scenarios {
namespace {

using namespace std::chrono_literals;

constexpr core::Resolution kSize{3, 2};

TEST(VideoPanes, GreyLevelsBecomeSquaresInTheirPlaces) {
  core::Image<std::uint8_t> gray(kSize);
  for (int i = 0; i < kSize.pixels(); ++i) gray(i % 3, i / 3) = static_cast<std::uint8_t>(40 * i);
  const Pane pane = gray_pane(gray, kSize);
  ASSERT_EQ(pane.size(), (core::Resolution{3 * kPaneScale, 2 * kPaneScale}));
  for (int y = 0; y < pane.height(); ++y)
    for (int x = 0; x < pane.width(); ++x) {
      const std::uint8_t level = gray(x / kPaneScale, y / kPaneScale);
      EXPECT_EQ(pane(x, y), (sim::Rgb{level, level, level})) << x << ' ' << y;
    }
}

TEST(VideoPanes, TenBitFramesKeepTheirUpperEight) {
  core::ApsFrame frame{0us, 1us, 10, core::Image<std::uint16_t>(kSize)};
  frame.gray(1, 0) = 1023;
  frame.gray(2, 1) = 4 * 77 + 3;
  EXPECT_EQ(gray_8_bit(frame)(1, 0), 255);
  EXPECT_EQ(gray_8_bit(frame)(2, 1), 77);
  frame.bits = 8;
  frame.gray(1, 0) = 200;
  EXPECT_EQ(gray_8_bit(frame)(1, 0), 200);
  EXPECT_TRUE(gray_8_bit({}).empty());
}

TEST(VideoPanes, NoPictureYetIsBlack) {
  const Pane pane = gray_pane({}, kSize);
  EXPECT_EQ(pane, Pane(pane.size(), sim::Rgb{0, 0, 0}));
  EXPECT_EQ(pane.width(), 3 * kPaneScale);
}

TEST(VideoPanes, EventsAreRedWhereBrighterAndGreenWhereDarker) {
  const std::vector<core::Event> events{{1us, 0, 0, true}, {2us, 2, 1, false}};
  const Pane pane = event_pane(events, kSize);
  const Pane still = event_pane({}, kSize);
  for (int y = 0; y < pane.height(); ++y)
    for (int x = 0; x < pane.width(); ++x) {
      const auto [red, green, blue] = pane(x, y);
      const int column = x / kPaneScale, row = y / kPaneScale;
      if (column == 0 && row == 0)
        EXPECT_GT(red, 2 * green);
      else if (column == 2 && row == 1)
        EXPECT_GT(green, 2 * red);
      else
        EXPECT_EQ(pane(x, y), still(x, y));
    }
}

TEST(VideoPanes, TheLastEventOfAPixelIsTheOneThatIsSeen) {
  const std::vector<core::Event> both{{1us, 1, 1, true}, {2us, 1, 1, false}};
  EXPECT_EQ(event_pane(both, kSize), event_pane(std::vector(both.begin() + 1, both.end()), kSize));
}

}  // namespace
}  // namespace nightjar::scenarios
