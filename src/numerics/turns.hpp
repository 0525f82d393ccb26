// Where a quantity that is known by its values turns round.
#pragma once

#include <functional>
#include <vector>

namespace rolling_ellipse {

// A number at each of some ascending times.
using Measure = std::function<std::vector<double>(const std::vector<double>& times)>;

// Sorts times and keeps each once.
void sort_once(std::vector<double>& times);

// Adds the turning points of a quantity to ascending times between which it is smooth: those of
// polynomials of degree 8 through nine places, by their Bernstein coefficients. Where a polynomial
// misses a tenth place by more than rounding, the part is halved, which makes it better by 2^9.
// False where that does not help: nothing is shown there. The rounding is that of the largest value
// and of a length beside.
bool add_turns(const Measure& measure, double length, std::vector<double>& times);

}  // namespace rolling_ellipse
