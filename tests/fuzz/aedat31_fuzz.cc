// The packets of AEDAT 3.1, and the header's other lines.
#include "tests/fuzz/recording_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const char* header = size % 8 == 0 ? "#!AER-DAT3.1\r\n" : "#!AER-DAT3.1\r\n#!END-HEADER\r\n";
  return nightjar::fuzz::read_recording(header, data, size, {37, 23});
}
