#pragma once

#include <cstdint>

namespace nightjar::esi {

/// For whoever walks through memory once: fetches what lies a page further on. Processors' own
/// prefetchers stop at the end of each page of 4 kB, and the wait for the next costs more than
/// the work on a page of events. There need not be any memory there.
[[gnu::always_inline]] inline void prefetch_ahead(const void* now) {
  constexpr std::uintptr_t kAhead = 4096;
  __builtin_prefetch(reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(now) + kAhead));
}

}  // namespace nightjar::esi
