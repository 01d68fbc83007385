#pragma once

namespace nightjar::sim {

/// Those beyond the plain one that the vector code is compiled for and this processor runs.
struct InstructionSets {
  bool avx2 = false;
  bool avx512 = false;  ///< f, bw, dq and vl.
};

inline InstructionSets instruction_sets() {
#if defined(__x86_64__)
  return {.avx2 = __builtin_cpu_supports("avx2") != 0,
          .avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")};
#else
  return {};
#endif
}

}  // namespace nightjar::sim
