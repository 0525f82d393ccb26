// Functions in two versions.
#pragma once

// The compiler makes a second version of a function for wide vectors, with the same bits, where the
// loader can choose it.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
#define ROLLING_ELLIPSE_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define ROLLING_ELLIPSE_WIDE
#endif
