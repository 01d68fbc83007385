#pragma once

#include "esi/leaky_sum.h"

namespace nightjar::esi {

#if defined(__x86_64__)
/// LeakySumVariant::integrate for processors with core::InstructionSets::avx512.
void integrate_avx512(const LeakySum& sum, EventRun& events, SumCell* cells);
#endif

}  // namespace nightjar::esi
