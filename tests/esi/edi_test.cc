#include "esi/edi.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/frames.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;

TEST(Edi, HandWorkedWalkUpAndDown) {
  // c = ln 2: L, 2 L, 4 L, 2 L for a quarter of the exposure each, B = 0.45 = L 9/4, L = 0.2;
  // it ends at 2 L.
  DoubleIntegralConfig config;
  config.search_contrast = false;
  config.contrast_log = std::log(2.0);
  Edi edi(config, {4, 4});
  edi.process(std::vector<core::Event>{{1s, 1, 2, true}, {2s, 1, 2, true}, {3s, 1, 2, false}});
  edi.add_frame(test::frame({4, 4}, 0s, 4s, 10, 460));
  core::Picture picture;
  edi.render(4s, picture);
  EXPECT_EQ(picture.gray(1, 2), 102);  // 0.4; history_s = 2 keeps what is 2 s old
  EXPECT_EQ(picture.gray(0, 0), 115);  // 460/1023
}

}  // namespace
}  // namespace nightjar::esi
