// Turns a few events into a picture with the installed library.

#include <cstdio>
#include <memory>
#include <vector>

#include "esi/make_reconstructor.h"
#include "esi/quality.h"

int main() {
  using namespace nightjar;
  constexpr core::Resolution kSensor{32, 24};
  const auto reconstructor = esi::make_reconstructor({}, kSensor);
  reconstructor->process(std::vector<core::Event>{{core::Time(1000), 3, 4, true}});
  core::Picture picture;
  reconstructor->render(core::Time(2000), picture);
  const esi::Quality quality = esi::compare(picture.gray, picture.gray);
  std::printf("%d %d %.3f\n", picture.gray(0, 0), picture.gray(3, 4), quality.ssim);
  return picture.gray(3, 4) > picture.gray(0, 0) ? 0 : 1;
}
