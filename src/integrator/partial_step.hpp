// Dense output of an implicit method, of its full order: the method itself, with a shorter step. A
// step so large that its parts cannot be solved has no more than its start.
#pragma once

#include "integrator/system.hpp"

namespace rolling_ellipse {

template <class Method, class System>
struct PartialStep {
    static constexpr int N = System::size;

    const System& f;
    Point<N> from;
    double h;

    // y at the fraction s of the step less y at its start.
    Vector<N> change(double s) const {
        Point<N> point = from;
        if (!Method(f).advance(point, s * h)) return Vector<N>::Zero();
        return (point.y - from.y) + (point.carry - from.carry);
    }
};

}  // namespace rolling_ellipse
