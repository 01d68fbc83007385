// Whole AEDAT4 files; give it a folder with small ones to begin from.
#include "tests/fuzz/recording_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return nightjar::fuzz::read_recording("#!AER-DAT4.0\r\n", data, size, {37, 23});
}
