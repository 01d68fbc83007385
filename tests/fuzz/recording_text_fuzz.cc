// Text, part by part.
#include "tests/fuzz/recording_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return nightjar::fuzz::read_recording("# t x y p\n", data, size, {37, 23});
}
