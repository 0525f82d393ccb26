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
// error by 2^9. Returns false if halving fails to help in some interval, in which turning points
// may then be missing. Rounding is judged by the largest value of the quantity and by `length`.
bool add_turns(const Measure& measure, double length, std::vector<double>& times);

}  // namespace rolling_ellipse
