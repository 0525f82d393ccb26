// End of the iteration, and dense output, of implicit methods.
#pragma once

#include <array>

#include "integrator/system.hpp"

namespace rolling_ellipse {

template <int N, int Stages>
using StageVectors = std::array<Vector<N>, Stages>;

// Size of each component of a step: an ordinary state, the point and the parts of the step.
template <int Stages, class System, int N = System::size>
Vector<N> size(const System& f, const Point<N>& point, const StageVectors<N, Stages>& parts) {
    Vector<N> sum = f.typical() + point.y.cwiseAbs();
    for (const Vector<N>& part : parts) sum += part.cwiseAbs();
    return sum;
}

// Stopping criterion of an iteration to the last bit: no component has a shrinking change any more
// (M. Antonana, J. Makazaga, A. Murua, Numer. Algorithms 76 (2017) 861, 3.2).
template <int N, int Stages>
class Stagnation {
  public:
    Stagnation() {
        last_.fill(Vector<N>::Constant(infinity));
        smallest_ = last_;
    }

    // Record the changes of an iteration; true if some component still shrinks. The larger one of
    // two successive changes counts, since in second-order equations large and small ones
    // alternate.
    bool shrinks(const StageVectors<N, Stages>& changes) {
        bool shrinking = false;
        const bool first = std::isinf(last_[0][0]);
        largest_ = Vector<N>::Zero();
        for (int i = 0; i < Stages; ++i) {
            for (int k = 0; k < N; ++k) {
                const double now = std::abs(changes[i][k]);
                const double change = std::fmax(now, last_[i][k]);
                last_[i][k] = now;
                if (first) first_[k] = std::fmax(first_[k], now);
                largest_[k] = std::fmax(largest_[k], change);
                if (change != 0.0 && (change < smallest_[i][k] || std::isinf(change))) {
                    smallest_[i][k] = change;
                    shrinking = true;
                }
            }
        }
        return shrinking;
    }

    // The largest of the last changes, relative to a size of each component.
    double left(const Vector<N>& size) const { return largest_.cwiseQuotient(size).maxCoeff(); }

    // True if the last changes are negligible relative to the first ones or to the size. (An
    // iteration that diverges from a tiny start has tiny changes, too.)
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

// Limit of iterations. An iteration ends when its changes are settled and do not shrink any more.
inline constexpr int most_iterations = 200;

// Dense output of an implicit method by a shorter step, hence of the full order. It stays at the
// start of the step if the stages of the shorter step do not converge.
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

}  // namespace rolling_ellipse
