// Functions compiled for several instruction sets, the best one that the machine has chosen when the
// program starts. No fused multiply-add and no reordering (see CMakeLists.txt): the same bits from each.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(LACUNA_PORTABLE)
#define LACUNA_VECTORISED __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define LACUNA_VECTORISED
#endif

// Functions written for AVX-512 (F, DQ, VL), to be called only where `has_avx512()`.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(LACUNA_PORTABLE)
#include <immintrin.h>
#define LACUNA_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl")))
namespace lacuna {
inline bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
}
}  // namespace lacuna
#endif
