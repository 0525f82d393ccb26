// The path of the centre at many angles, of which the next is mostly close to the last: Taylor
// series of the integral of h, physics (9), each about the middle of an interval.
#pragma once

#include "geometry/ellipse.hpp"
#include "numerics/series.hpp"

namespace rolling_ellipse {

class PathSeries {
  public:
    explicit PathSeries(const Axes& axes);

    // As centre_path, to the last place or two; what was asked before changes no bit.
    double operator()(double theta) {
        if (!(low_ <= theta && theta < high_)) move_to(theta);
        return value_in_pairs(path_, theta - middle_);
    }

  private:
    void move_to(double theta);
    double distance(double theta) const;

    Axes axes_;
    double c2_;
    double off_axis_;  // of the roots of h, which lie beside the flat positions
    double low_ = 1.0;
    double high_ = 0.0;  // at first no interval at all
    double middle_ = 0.0;
    Series path_{};
};

}  // namespace rolling_ellipse
