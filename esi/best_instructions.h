#pragma once

#include "core/instruction_sets.h"

namespace nightjar::esi {

#if defined(__x86_64__)
// By value: what is written in the loop is then known to change nothing that was captured.
template <class Body>
[[gnu::target("avx2")]] void run_avx2(Body body) {
  body();
}
template <class Body>
[[gnu::target("avx512f,avx512bw,avx512dq,avx512vl,prefer-vector-width=512")]] void run_avx512(
    Body body) {
  body();
}
#endif

/// Runs `body`, a lambda with __attribute__((always_inline)) and a loop to be vectorised, as
/// compiled for the best of `sets`. Our code is compiled so that all give the same bits
/// (docs/decisions/0007).
template <class Body>
void with_best_instructions(const Body& body,
                            core::InstructionSets sets = core::instruction_sets()) {
#if defined(__x86_64__)
  if (sets.avx512) return run_avx512(body);
  if (sets.avx2) return run_avx2(body);
#endif
  body();
}

}  // namespace nightjar::esi
