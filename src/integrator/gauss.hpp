// Gauss-Legendre collocation of order 2 s: symplectic, symmetric, its rounding error a random walk.
// Fixed-point iteration to the last bit, increments L_j = h b_j f(Y_j) where the h b_j sum to h,
// and compensated summation, as in
//     E. Hairer, R. I. McLachlan, A. Razakarivony, BIT Numer. Math. 48 (2008) 231,
//     M. Antonana, J. Makazaga, A. Murua, Numer. Algorithms 76 (2017) 861.
#pragma once

#include "integrator/collocation.hpp"
#include "integrator/implicit.hpp"

namespace rolling_ellipse {

template <int S, class System>
class Gauss {
  public:
    static constexpr int N = System::size;
    static constexpr bool controls_error = false;

    explicit Gauss(const System& system) : f_(system) {}

    StepCounts counts;

    // Takes a step; false if the stages do not converge because it is too large.
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

    // h b_j; the outer two are chosen so that the sum is h.
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

}  // namespace rolling_ellipse
