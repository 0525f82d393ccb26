// Functions compiled in two versions.
#pragma once

// If the loader can choose between versions of a function, the compiler adds a version for wide
// vectors, which gives the same bits.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
#define ROLLING_ELLIPSE_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define ROLLING_ELLIPSE_WIDE
#endif
