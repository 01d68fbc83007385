// Any bytes at all are either events, ordered and on the sensor, or an
// invalid_argument whose text is one line. Anything else is a finding.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "camera/event_text.h"

namespace {

bool is_sound(const nightjar::camera::EventRecording& recording) {
  nightjar::core::Time last{};
  for (const auto& event : recording.events) {
    if (event.t < last || event.x >= recording.size.width_px || event.y >= recording.size.height_px)
      return false;
    last = event.t;
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  try {
    if (!is_sound(nightjar::camera::read_event_text(in, "fuzz.txt"))) std::abort();
  } catch (const std::invalid_argument& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
