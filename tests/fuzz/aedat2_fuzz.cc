// The records of AEDAT 2.0, and the header's other lines.
#include "tests/fuzz/recording_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return nightjar::fuzz::read_recording("#!AER-DAT2.0\r\n", data, size, {240, 180});
}
