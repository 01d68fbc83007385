#pragma once

#include "esi/memory_cell.h"

namespace nightjar::esi {

#if defined(__x86_64__)
/// MemoryVariant::integrate for processors with core::InstructionSets::avx2.
void integrate_avx2(EventRun& events, MemoryCell* cells);

/// The same for those with core::InstructionSets::avx512.
void integrate_avx512(EventRun& events, MemoryCell* cells);

/// MemoryVariant::features for those.
void features_avx512(const MemoryCell* cells, int width, std::uint32_t now_us, std::int16_t* to);
#endif

}  // namespace nightjar::esi
