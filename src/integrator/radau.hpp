// Radau IIA with three stages, order 5: implicit, L-stable, also for differential-algebraic systems
// diag(mass) y' = f(t, y). E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, IV.8:
// simplified Newton iteration in coordinates that split the stages into a real and a complex
// system, each of the size of y.
#pragma once

#include <complex>

#include "integrator/collocation.hpp"
#include "integrator/implicit.hpp"
#include "numerics/lu.hpp"

namespace rolling_ellipse {

template <class System>
class Radau {
  public:
    static constexpr int N = System::size;
    static constexpr bool controls_error = false;

    explicit Radau(const System& system) : f_(system) {}

    StepCounts counts;

    // Takes a step; false if the stages do not converge because it is too large.
    bool advance(Point<N>& point, double h) {
        constexpr double rounding = 2 * epsilon;
        const std::complex<double> pair(C::alpha, C::beta);
        const Matrix<N> jacobian = f_.jacobian(point.t, point.y);
        const Vector<N> mass = f_.mass() / h;
        Matrix<N> real_matrix = -jacobian;
        ComplexMatrix complex_matrix;
        for (int k = 0; k < N * N; ++k) complex_matrix(k) = real_matrix(k);
        for (int k = 0; k < N; ++k) {
            real_matrix(k, k) += C::gamma * mass[k];
            complex_matrix(k, k) += pair * mass[k];
        }
        const LU<double, N> real(real_matrix);
        const LU<std::complex<double>, N> complex(complex_matrix);

        StageVectors<N, 3> z;  // the stages minus y
        StageVectors<N, 3> w;  // inverse_transform z
        z.fill(Vector<N>::Zero());
        w.fill(Vector<N>::Zero());
        Stagnation<N, 3> stagnation;
        bool shrinking = true;
        for (int i = 0; shrinking || !stagnation.settled(size<3>(f_, point, z)); ++i) {
            if (i == most_iterations) return false;
            StageVectors<N, 3> slopes;
            for (int j = 0; j < 3; ++j) {
                slopes[j] = f_(point.t + C::c[j] * h, point.y + (point.carry + z[j]));
            }
            counts.evaluations += 3;
            const StageVectors<N, 3> g = transformed(C::inverse_transform, slopes);
            const Vector<N> real_change = real.solve(g[0] - C::gamma * mass.cwiseProduct(w[0]));
            ComplexVector residual;
            for (int k = 0; k < N; ++k) {
                residual[k] = std::complex<double>(g[1][k], g[2][k]) -
                              pair * mass[k] * std::complex<double>(w[1][k], w[2][k]);
            }
            const ComplexVector complex_change = complex.solve(residual);
            w[0] += real_change;
            w[1] += complex_change.real();
            w[2] += complex_change.imag();
            const StageVectors<N, 3> next = transformed(C::transform, w);
            StageVectors<N, 3> changes;
            for (int j = 0; j < 3; ++j) changes[j] = next[j] - z[j];
            z = next;
            if (!in_range<N>(z[2])) return false;
            shrinking =
                stagnation.shrinks(changes) && stagnation.left(size<3>(f_, point, z)) > rounding;
        }
        add<N>(point, z[2]);  // the last stage is the end of the step
        return true;
    }

    PartialStep<Radau<System>, System> dense_output(const Point<N>& from, double h) const {
        return {f_, from, h};
    }

  private:
    using C = RadauCoefficients;
    using ComplexVector = Eigen::Matrix<std::complex<double>, N, 1>;
    using ComplexMatrix = Eigen::Matrix<std::complex<double>, N, N>;

    static StageVectors<N, 3> transformed(const double (&rows)[3][3], const StageVectors<N, 3>& v) {
        StageVectors<N, 3> result;
        for (int i = 0; i < 3; ++i) {
            result[i] = rows[i][0] * v[0] + rows[i][1] * v[1] + rows[i][2] * v[2];
        }
        return result;
    }

    const System& f_;
};

}  // namespace rolling_ellipse
