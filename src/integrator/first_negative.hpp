// The first time at which one of several margins becomes negative, from samples in ascending time.
#pragma once

#include <array>
#include <cmath>

#include "numerics/bisect.hpp"
#include "numerics/numbers.hpp"

namespace rolling_ellipse {

// Samples per step. A parabola finds a dip below zero that is narrower than an eighth of a step.
inline constexpr int looks_per_step = 8;

// Follows N margins from sample to sample. A dip below zero between two positive samples is found
// by the parabola through three samples.
template <int N>
class FirstNegative {
  public:
    // Sample `margins`, a function of t that returns std::array<double, N>, at the next time. True
    // once a negative value was found.
    template <class Margins>
    bool look(double t, const Margins& margins) {
        looks_ = {looks_[1], looks_[2], Look{t, margins(t)}};
        ++count_;
        for (int i = 0; i < N; ++i) examine(i, margins);
        return found() < infinity;
    }

    double found() const { return time_; }
    int which() const { return which_; }

  private:
    struct Look {
        double t;
        std::array<double, N> margins;
    };

    template <class Margins>
    void examine(int i, const Margins& margins) {
        const auto& [before, middle, now] = looks_;
        if (now.margins[i] < 0) {
            keep(i, count_ == 1 ? now.t : crossing(i, middle.t, now.t, margins));
        } else if (count_ > 2 && middle.margins[i] < before.margins[i] &&
                   middle.margins[i] <= now.margins[i]) {
            const double bottom = lowest(before, middle, now, i, margins);
            if (margins(bottom)[i] < 0) {
                keep(i, crossing(i, bottom < middle.t ? before.t : middle.t, bottom, margins));
            }
        }
    }

    void keep(int i, double t) {
        if (!(t < time_)) return;
        time_ = t;
        which_ = i;
    }

    // The first time, in doubles, at which margin i is negative, between a good and a bad time.
    template <class Margins>
    static double crossing(int i, double good, double bad, const Margins& margins) {
        return bisect(good, bad, [&](double t) { return margins(t)[i] < 0; }).high;
    }

    // The minimum by the parabola through three samples, then by one through closer samples.
    template <class Margins>
    static double lowest(const Look& a, const Look& b, const Look& c, int i,
                         const Margins& margins) {
        const double rough = bottom_of_parabola(a, b, c, i);
        if (!std::isfinite(rough)) return b.t;  // the margins have overflowed
        const double beside = 0.05 * (c.t - a.t);
        const auto at = [&](double t) { return Look{t, margins(t)}; };
        if (!(a.t < rough - beside && rough + beside < c.t)) return rough;
        const double fine =
            bottom_of_parabola(at(rough - beside), at(rough), at(rough + beside), i);
        return std::abs(fine - rough) < beside ? fine : rough;
    }

    static double bottom_of_parabola(const Look& a, const Look& b, const Look& c, int i) {
        const double left = (b.margins[i] - a.margins[i]) / (b.t - a.t);
        const double right = (c.margins[i] - b.margins[i]) / (c.t - b.t);
        return 0.5 * (a.t + b.t) + left / (left - right) * 0.5 * (c.t - a.t);
    }

    std::array<Look, 3> looks_{};
    long count_ = 0;
    double time_ = infinity;
    int which_ = 0;
};

}  // namespace rolling_ellipse
