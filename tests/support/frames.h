#pragma once

#include "core/image.h"
#include "core/random.h"

namespace nightjar::test {

/// A frame of one value.
inline core::ApsFrame frame(core::Resolution size, core::Time begin, core::Time end, int bits,
                            std::uint16_t value) {
  return {begin, end, bits, core::Image<std::uint16_t>(size, value)};
}

/// A frame of values spread evenly at random over all that `bits` can hold.
inline core::ApsFrame random_frame(core::Resolution size, core::Time begin, core::Time end,
                                   int bits, int seed) {
  core::ApsFrame frame{begin, end, bits, core::Image<std::uint16_t>(size)};
  core::Random random = core::random_stream(static_cast<std::uint64_t>(seed), "test.frames");
  for (auto& value : frame.gray.pixels())
    value = static_cast<std::uint16_t>(random() % (1u << bits));
  return frame;
}

}  // namespace nightjar::test
