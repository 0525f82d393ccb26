// The interpolant of an explicit method.
#pragma once

#include <array>

#include "integrator/system.hpp"

namespace rolling_ellipse {

// The dense output of a step (HNW II.6), the cubic Hermite polynomial with terms of higher order:
//     y(s) - y(0) = s (F0 + (1-s) (F1 + s (F2 + (1-s) (F3 + s (F4 + ...))))),   0 <= s <= 1.
template <int N, int Terms>
struct DenseOutput {
    static constexpr bool of_full_order = false;

    std::array<Vector<N>, 3 + Terms> terms;

    Vector<N> change(double s) const {
        Vector<N> value = terms.back();
        for (int i = 1 + Terms; i >= 0; --i) {
            const double factor = i % 2 == 0 ? 1 - s : s;
            for (int j = 0; j < N; ++j) value[j] = terms[i][j] + factor * value[j];
        }
        return s * value;
    }
};

}  // namespace rolling_ellipse
