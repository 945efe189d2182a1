// SPDX-License-Identifier: Apache-2.0
// Compiles a plain loop for several instruction sets within plain code. The compiler vectorises it
// automatically. Only for whole numbers and for operations that have one exact result: such a loop is no
// kernel of Highway.
#pragma once

// The sanitizers are not there yet where the loader chooses one of them.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define LACUNA_VECTORISED __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define LACUNA_VECTORISED
#endif
