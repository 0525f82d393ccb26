// Functions compiled for several vector levels, of which the loader takes the best one of the
// machine: wider registers, the same operations and so the same bits (no fused multiply-add, see
// CMakeLists.txt). Not under ThreadSanitizer, which does not run yet when the loader chooses.
#pragma once

#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__)
#define ROLLING_ELLIPSE_VECTOR_LEVELS [[gnu::target_clones("avx512f", "avx2", "default")]]
#else
#define ROLLING_ELLIPSE_VECTOR_LEVELS
#endif
