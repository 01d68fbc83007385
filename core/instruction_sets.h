#pragma once

namespace nightjar::core {

/// Those beyond the plain one that the vector code is compiled for and this processor runs.
struct InstructionSets {
  bool avx2 = false;    ///< And fma.
  bool avx512 = false;  ///< f, bw, cd, dq and vl, and fma.
};

inline InstructionSets instruction_sets() {
#if defined(__x86_64__)
  const bool fma = __builtin_cpu_supports("fma") != 0;
  return {.avx2 = fma && __builtin_cpu_supports("avx2"),
          .avx512 = fma && __builtin_cpu_supports("avx512f") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
                    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")};
#else
  return {};
#endif
}

}  // namespace nightjar::core
