#include "esi/fedi.h"

#include <gtest/gtest.h>

#include "esi/edi.h"
#include "tests/support/events.h"
#include "tests/support/frames.h"

namespace nightjar::esi {
namespace {

using namespace std::chrono_literals;

// The same sums in the same order: the same bits, and so the same contrast found.
TEST(Fedi, GivesEdisPicturesAndContrasts) {
  constexpr core::Resolution kSensor{33, 21};
  Fedi fedi({}, kSensor);
  Edi edi({}, kSensor);
  const auto events = test::random_events(kSensor, 60000, 2s, /*seed=*/9);
  auto next = events.begin();
  for (int i = 1; i < 20; ++i) {
    const auto from = next;
    while (next != events.end() && next->t < i * 100ms) ++next;
    const auto frame = test::random_frame(kSensor, i * 100ms - 80ms, i * 100ms - 10ms, 8, i);
    core::Picture a, b;
    for (DoubleIntegral* method :
         {static_cast<DoubleIntegral*>(&fedi), static_cast<DoubleIntegral*>(&edi)}) {
      method->process(std::span(from, next));
      method->add_frame(frame);
    }
    fedi.render(i * 100ms, a);
    edi.render(i * 100ms, b);
    ASSERT_EQ(a.gray, b.gray) << i;
    ASSERT_EQ(fedi.contrast_log(), edi.contrast_log()) << i;
  }
}

}  // namespace
}  // namespace nightjar::esi
