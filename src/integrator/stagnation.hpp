// When to end an iteration that is carried to the last bit: once the changes of no component
// shrink any more (M. Antonana, J. Makazaga, A. Murua, Numer. Algorithms 76 (2017) 861, 3.2).
#pragma once

#include <array>

#include "common.hpp"

namespace rolling_ellipse {

template <int N, int Stages>
using StageVectors = std::array<Vector<N>, Stages>;

template <int N, int Stages>
class Stagnation {
  public:
    Stagnation() { smallest_.fill(Vector<N>::Constant(infinity)); }

    // Take note of the changes of an iteration, and say whether they still shrink somewhere.
    bool shrinks(const StageVectors<N, Stages>& changes) {
        bool shrinking = false;
        largest_ = Vector<N>::Zero();
        for (int i = 0; i < Stages; ++i) {
            for (int k = 0; k < N; ++k) {
                const double change = std::abs(changes[i][k]);
                largest_[k] = std::fmax(largest_[k], change);
                if (change != 0.0 && change < smallest_[i][k]) {
                    smallest_[i][k] = change;
                    shrinking = true;
                }
            }
        }
        return shrinking;
    }

    // Were the last changes small beside the size of the step? Stages that diverge do so in every
    // component; what is left where a component vanishes by cancellation is rounding of the others.
    bool settled(const Vector<N>& size) const {
        constexpr double small = 1e-6;
        return (largest_.array() <= small * size.array()).any();
    }

  private:
    StageVectors<N, Stages> smallest_;
    Vector<N> largest_ = Vector<N>::Zero();
};

}  // namespace rolling_ellipse
