// Solves small systems of linear equations by LU decomposition with partial pivoting: G. H. Golub,
// C. F. Van Loan, Matrix Computations, 4th ed., 3.4. The loops are plain: for so few equations
// Eigen's blocked loops gain nothing and take seconds to compile for each size.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

namespace rolling_ellipse {

inline double reciprocal(double x) { return 1.0 / x; }

// 1/z, scaled so that no square overflows. The compiler's complex division calls a library
// function, whose operations differ between versions and are fused on some processors.
inline std::complex<double> reciprocal(std::complex<double> z) {
    const double size = std::fmax(std::abs(z.real()), std::abs(z.imag()));
    const double x = z.real() / size;
    const double y = z.imag() / size;
    const double norm = size * (x * x + y * y);
    return {x / norm, -y / norm};
}

template <class Number, int N>
class LU {
  public:
    using Vector = Eigen::Matrix<Number, N, 1>;
    using Matrix = Eigen::Matrix<Number, N, N>;

    explicit LU(const Matrix& matrix) : factors_(matrix) {
        for (int k = 0; k < N; ++k) {
            pivots_[k] = k;
            for (int i = k + 1; i < N; ++i) {
                if (std::abs(factors_(i, k)) > std::abs(factors_(pivots_[k], k))) pivots_[k] = i;
            }
            if (pivots_[k] != k) {
                for (int j = 0; j < N; ++j) std::swap(factors_(k, j), factors_(pivots_[k], j));
            }
            inverses_[k] = reciprocal(factors_(k, k));
            for (int i = k + 1; i < N; ++i) factors_(i, k) *= inverses_[k];
            for (int j = k + 1; j < N; ++j) subtract(factors_(k, j), k, &factors_(0, j));
        }
    }

    // The solution for a right-hand side; infinite or NaN if the matrix is singular.
    Vector solve(Vector v) const {
        for (int k = 0; k < N; ++k) std::swap(v[k], v[pivots_[k]]);
        for (int k = 0; k < N; ++k) subtract(v[k], k, v.data());
        for (int k = N - 1; k >= 0; --k) {
            v[k] *= inverses_[k];
            for (int i = 0; i < k; ++i) v[i] -= factors_(i, k) * v[k];
        }
        return v;
    }

  private:
    // Subtracts `times` times column k of the lower factor from a column, below row k.
    void subtract(const Number times, int k, Number* column) const {
        for (int i = k + 1; i < N; ++i) column[i] -= factors_(i, k) * times;
    }

    Matrix factors_;  // both factors; the lower one without its unit diagonal
    std::array<Number, N> inverses_;
    std::array<int, N> pivots_;  // the row with which each row is exchanged
};

}  // namespace rolling_ellipse
