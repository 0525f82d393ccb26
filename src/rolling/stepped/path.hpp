// The path of the centre at many angles, each mostly close to the one before: Taylor series of the
// integral of h, physics (9), each about the middle of an interval. A body that rolls over meets
// the same intervals in each half turn, so that they are kept.
#pragma once

#include <cmath>
#include <vector>

#include "geometry/ellipse.hpp"
#include "numerics/series.hpp"

namespace rolling_ellipse {

class PathSeries {
  public:
    explicit PathSeries(const Axes& axes);

    // centre_path to 2 ulp. Its bits do not depend on earlier calls, nor on the sign of theta.
    double operator()(double theta) {
        const double angle = std::abs(theta);
        if (!here_.holds(angle)) move_to(angle);
        const double path = value(here_.path, angle - here_.middle);
        return theta < 0 ? -path : path;
    }

  private:
    struct Interval {
        double low = 1.0;  // an empty interval before the first call
        double high = 0.0;
        double middle = 0.0;
        Series path{};

        bool holds(double angle) const { return low <= angle && angle < high; }
    };

    void move_to(double angle);
    Interval interval_at(double angle) const;
    double distance(double angle) const;

    Axes axes_;
    double c2_;
    double off_axis_;  // imaginary part of the roots of h, which lie beside the flat positions
    Interval here_;
    std::vector<Interval> known_;
};

}  // namespace rolling_ellipse
