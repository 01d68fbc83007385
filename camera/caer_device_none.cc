// Takes the place of caer_device_libcaer.cc where there is no libcaer.
#include <stdexcept>

#include "camera/caer_device.h"

namespace nightjar::camera {

std::unique_ptr<CaerDevice> open_caer_device(const std::string&) {
  throw std::invalid_argument(
      "source.type = caer, but this nightjar was built without libcaer: install it from "
      "https://gitlab.com/inivation/dv/libcaer (docs/hardware.md has the commands), then build "
      "nightjar anew");
}

}  // namespace nightjar::camera
