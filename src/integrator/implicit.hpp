// Implicit methods, iterated to the last bit: Gauss-Legendre collocation and Radau IIA.
#pragma once

#include <array>
#include <complex>

#include "integrator/collocation.hpp"
#include "integrator/system.hpp"
#include "numerics/lu.hpp"

namespace rolling_ellipse {

template <int N, int Stages>
using StageVectors = std::array<Vector<N>, Stages>;

// The scale for the errors of each component in a step: the sum of the magnitudes of a typical
// state, the point and the increments.
template <int Stages, class System, int N = System::size>
Vector<N> size(const System& f, const Point<N>& point, const StageVectors<N, Stages>& parts) {
    Vector<N> sum = f.typical() + point.y.cwiseAbs();
    for (const Vector<N>& part : parts) sum += part.cwiseAbs();
    return sum;
}

// Stopping criterion for an iteration to the last bit: the change of every component has stopped
// shrinking (M. Antonana, J. Makazaga, A. Murua, Numer. Algorithms 76 (2017) 861, 3.2).
template <int N, int Stages>
class Stagnation {
  public:
    Stagnation() {
        last_.fill(Vector<N>::Constant(infinity));
        smallest_ = last_;
    }

    // Records the changes of an iteration; true if some component's change is still shrinking. The
    // larger of two successive changes counts, since in second-order equations large and small
    // changes alternate.
    bool shrinks(const StageVectors<N, Stages>& changes) {
        bool shrinking = false;
        const bool first = std::isinf(last_[0][0]);
        largest_ = Vector<N>::Zero();
        for (int i = 0; i < Stages; ++i) {
            for (int k = 0; k < N; ++k) {
                const double now = std::abs(changes[i][k]);
                const double change = std::max(last_[i][k], now);
                last_[i][k] = now;
                if (first) first_[k] = std::max(first_[k], now);
                largest_[k] = std::max(largest_[k], change);
                if (change != 0.0 && (change < smallest_[i][k] || std::isinf(change))) {
                    smallest_[i][k] = change;
                    shrinking = true;
                }
            }
        }
        return shrinking;
    }

    // The largest of the most recent changes, relative to the scale of its component.
    double left(const Vector<N>& size) const { return largest_.cwiseQuotient(size).maxCoeff(); }

    // True if the most recent changes are far smaller than the first ones, or near rounding errors.
    // (A larger fixed bound would accept an iteration that diverges slowly from tiny values.)
    bool settled(const Vector<N>& size) const {
        constexpr double share_of_first = 1e-6;
        constexpr double near_rounding = 1e-11;
        const double first = first_.cwiseQuotient(size).maxCoeff();
        return left(size) <= std::fmax(near_rounding, share_of_first * first);
    }

  private:
    StageVectors<N, Stages> last_;
    StageVectors<N, Stages> smallest_;
    Vector<N> largest_ = Vector<N>::Zero();
    Vector<N> first_ = Vector<N>::Zero();
};

// Limit on the number of iterations of a step. Normally the changes settle earlier.
inline constexpr int most_iterations = 200;

// Dense output of an implicit method, computed with a shorter step and hence of full order. The
// change is 0 if the stages of the shorter step do not converge.
template <class Method, class System>
struct PartialStep {
    static constexpr int N = System::size;
    static constexpr bool of_full_order = true;

    const System& f;
    Point<N> from;
    double h;

    // y at the fraction s of the step, minus y at its start.
    Vector<N> change(double s) const {
        Point<N> point = from;
        if (!Method(f).advance(point, s * h)) return Vector<N>::Zero();
        return (point.y - from.y) + (point.carry - from.carry);
    }
};

// Gauss-Legendre collocation with S stages, of order 2 S: symplectic and symmetric, with a rounding
// error that grows like a random walk. It uses fixed-point iteration to the last bit, increments
// L_j = h b_j f(Y_j) with h b_j that sum to h, and compensated summation, as in
//     E. Hairer, R. I. McLachlan, A. Razakarivony, BIT Numer. Math. 48 (2008) 231,
//     M. Antonana, J. Makazaga, A. Murua, Numer. Algorithms 76 (2017) 861.
template <int S, class System>
class Gauss {
  public:
    static constexpr int N = System::size;
    static constexpr bool controls_error = false;

    explicit Gauss(const System& system) : f_(system) {}

    StepCounts counts;

    // Takes a step; false if the stages do not converge because the step is too large.
    bool advance(Point<N>& point, double h) {
        const std::array<double, S> hb = weights(h);
        // First guess: the collocation polynomial of the previous step, extrapolated.
        StageVectors<N, S> stages;
        for (int j = 0; j < S; ++j) {
            stages[j] = point.y;
            if (h == last_step_) stages[j] += combination(Coefficients::nu[j]);
        }
        Stagnation<N, S> stagnation;
        bool shrinking = true;
        for (int i = 0; shrinking || !stagnation.settled(size<S>(f_, point, increments_)); ++i) {
            if (i == most_iterations) return false;
            for (int j = 0; j < S; ++j) {
                increments_[j] = hb[j] * f_(point.t + Coefficients::c[j] * h, stages[j]);
            }
            counts.evaluations += S;
            StageVectors<N, S> changes;
            for (int j = 0; j < S; ++j) {
                const Vector<N> stage = point.y + (point.carry + combination(Coefficients::mu[j]));
                changes[j] = stage - stages[j];
                stages[j] = stage;
            }
            if (!in_range<N>(stages[S - 1])) return false;
            shrinking = stagnation.shrinks(changes);
        }
        Vector<N> sum = increments_[0];
        for (int j = 1; j < S; ++j) sum += increments_[j];
        add<N>(point, sum);
        last_step_ = h;
        return true;
    }

    PartialStep<Gauss<S, System>, System> dense_output(const Point<N>& from, double h) const {
        return {f_, from, h};
    }

  private:
    using Coefficients = GaussCoefficients<S>;

    // The weights h b_j of a step; the first and last are adjusted so that all of them sum to h.
    static std::array<double, S> weights(double h) {
        std::array<double, S> hb;
        double rest = h;
        for (int j = 1; j + 1 < S; ++j) {
            hb[j] = h * Coefficients::b[j];
            rest -= hb[j];
        }
        hb[0] = hb[S - 1] = rest / 2;
        return hb;
    }

    Vector<N> combination(const double (&row)[S]) const {
        Vector<N> sum = row[0] * increments_[0];
        for (int j = 1; j < S; ++j) sum += row[j] * increments_[j];
        return sum;
    }

    const System& f_;
    StageVectors<N, S> increments_;
    double last_step_ = 0.0;  // size of the step that filled `increments_`
};

// Radau IIA with three stages, of order 5: implicit, L-stable, and applicable to
// differential-algebraic systems diag(mass) y' = f(t, y). As in E. Hairer, G. Wanner, Solving
// Ordinary Differential Equations II, IV.8, simplified Newton iteration is done in coordinates that
// split the stages into a real and a complex system, each of the size of y.
template <class System>
class Radau {
  public:
    static constexpr int N = System::size;
    static constexpr bool controls_error = false;

    explicit Radau(const System& system) : f_(system) {}

    StepCounts counts;

    // Takes a step; false if the stages do not converge because the step is too large.
    bool advance(Point<N>& point, double h) {
        constexpr double rounding = 2 * epsilon;
        const std::complex<double> pair(C::alpha, C::beta);
        const Matrix<N> jacobian = f_.jacobian(point.t, point.y);
        const Vector<N> mass = f_.mass() / h;
        Matrix<N> real_matrix = -jacobian;
        ComplexMatrix complex_matrix = real_matrix.template cast<std::complex<double>>();
        real_matrix.diagonal() += C::gamma * mass;
        complex_matrix.diagonal() += pair * mass;
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
