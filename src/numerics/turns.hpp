// Turning points of a quantity known only by its values.
#pragma once

#include <functional>
#include <vector>

namespace rolling_ellipse {

// The quantity at ascending times.
using Measure = std::function<std::vector<double>(const std::vector<double>& times)>;

// Sorts times and removes duplicates.
void sort_once(std::vector<double>& times);

// Adds the turning points of a quantity to ascending times between which it is smooth. They are
// found from the Bernstein coefficients of polynomials of degree 8 through nine points. If a
// polynomial misses a tenth point by more than rounding, its interval is halved, which divides the
// error by 2^9. Returns false if the polynomial of some interval still misses after the last
// halving; turning points may then be missing in this interval. The rounding error is estimated
// from the largest magnitude of the quantity or from `length`, if that is larger, and from the
// rounding of the times.
bool add_turns(const Measure& measure, double length, std::vector<double>& times);

}  // namespace rolling_ellipse
