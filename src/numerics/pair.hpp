// Two doubles that are computed at once where the processor can: the same bits as one after the
// other.
#pragma once

namespace rolling_ellipse {

#if defined(__GNUC__)

using Pair = double __attribute__((vector_size(2 * sizeof(double))));

#else

struct Pair {
    double values[2];

    double& operator[](int i) { return values[i]; }
    double operator[](int i) const { return values[i]; }
    Pair& operator+=(const Pair& other) {
        values[0] += other[0];
        values[1] += other[1];
        return *this;
    }
};
inline Pair operator+(Pair x, const Pair& y) { return x += y; }
inline Pair operator-(const Pair& x, const Pair& y) { return {{x[0] - y[0], x[1] - y[1]}}; }
inline Pair operator*(const Pair& x, const Pair& y) { return {{x[0] * y[0], x[1] * y[1]}}; }
inline Pair operator*(double factor, const Pair& x) { return {{factor * x[0], factor * x[1]}}; }

#endif

inline Pair pair(double first, double second) { return Pair{first, second}; }

}  // namespace rolling_ellipse
