// Which of the namesakes compiled for several instruction sets (core/lanes) this machine runs.
#pragma once

// A plain loop that the compiler vectorises by itself, compiled for several instruction sets beside the code
// around it.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(LACUNA_PORTABLE)
#define LACUNA_VECTORISED __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define LACUNA_VECTORISED
#endif

#if defined(__x86_64__) && !defined(LACUNA_PORTABLE)

// Declares a function that a *.lanes.cpp defines, in each of their namespaces.
#define LACUNA_DECLARE(Signature, name) \
  inline namespace v4 {                 \
  Signature name;                       \
  }                                     \
  inline namespace v3 {                 \
  Signature name;                       \
  }                                     \
  inline namespace plain {              \
  Signature name;                       \
  }
#define LACUNA_FASTEST(name)                        \
  (__builtin_cpu_supports("x86-64-v4")   ? v4::name \
   : __builtin_cpu_supports("x86-64-v3") ? v3::name \
                                         : plain::name)

#else

#define LACUNA_DECLARE(Signature, name) \
  inline namespace plain {              \
  Signature name;                       \
  }
#define LACUNA_FASTEST(name) plain::name

#endif

// Declares it, and the best one that the machine runs under its name in namespace lacuna::fastest: not where
// the compiler may use instructions that the machine lacks.
#if defined(LACUNA_LANE_SOURCE)
#define LACUNA_DISPATCH LACUNA_DECLARE
#else
#define LACUNA_DISPATCH(Signature, name)               \
  LACUNA_DECLARE(Signature, name)                      \
  namespace fastest {                                  \
  inline Signature* const name = LACUNA_FASTEST(name); \
  }
#endif
