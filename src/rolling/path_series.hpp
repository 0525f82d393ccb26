// The path of the centre at many angles, of which the next is mostly close to the last: Taylor
// series of the integral of h, physics (9), each about the middle of an interval. A body that rolls
// over comes back to the same intervals in each half turn.
#pragma once

#include <vector>

#include "geometry/ellipse.hpp"
#include "numerics/series.hpp"

namespace rolling_ellipse {

class PathSeries {
  public:
    explicit PathSeries(const Axes& axes);

    // As centre_path, to the last place or two; what was asked before changes no bit.
    double operator()(double theta) {
        if (!here_.holds(theta)) move_to(theta);
        return value(here_.path, theta - here_.middle);
    }

  private:
    struct Interval {
        double low = 1.0;
        double high = 0.0;  // at first no interval at all
        double middle = 0.0;
        Series path{};

        bool holds(double theta) const { return low <= theta && theta < high; }
    };

    void move_to(double theta);
    Interval interval_at(double theta) const;
    double distance(double theta) const;

    Axes axes_;
    double c2_;
    double off_axis_;  // of the roots of h, which lie beside the flat positions
    Interval here_;
    std::vector<Interval> known_;
};

}  // namespace rolling_ellipse
