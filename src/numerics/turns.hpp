// Turning points of a quantity that is known only by its values.
#pragma once

#include <functional>
#include <vector>

namespace rolling_ellipse {

// Returns the values of a quantity at ascending times.
using Measure = std::function<std::vector<double>(const std::vector<double>& times)>;

// Sorts times and removes duplicates.
void sort_once(std::vector<double>& times);

// Adds the turning points of a quantity to ascending times between which it is smooth. In each
// interval, they are computed from the Bernstein coefficients of a polynomial of degree 8 through
// nine points. If the polynomial misses a tenth point by more than the rounding error, the interval
// is halved, which divides the error by 2^9. Returns false if some polynomial still misses its
// tenth point after the last halving; its interval may then lack turning points. The rounding error
// is estimated from the largest magnitude of the quantity or from `length`, if that is larger, and
// from the rounding of the times.
bool add_turns(const Measure& measure, double length, std::vector<double>& times);

}  // namespace rolling_ellipse
