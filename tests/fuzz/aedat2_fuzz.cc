// The records of AEDAT 2.0 (events, reads of active pixels, inertial samples), and the header's
// other lines. The sensor is small, so that frames come to be whole.
#include "tests/fuzz/recording_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return nightjar::fuzz::read_recording("#!AER-DAT2.0\r\n", data, size, {4, 3});
}
