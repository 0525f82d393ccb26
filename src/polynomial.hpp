// Polynomials of small degree on one interval: signs that are proved, roots that are all found.
//
// Every coefficient carries the sum of the magnitudes of the terms it was made from, so that each
// step knows how far rounding may have moved it.
#pragma once

#include <array>
#include <initializer_list>
#include <vector>

namespace rolling_ellipse {

inline constexpr int largest_degree = 12;

// A number and the magnitude of the terms that were summed up to it.
struct Tracked {
    double value = 0.0;
    double magnitude = 0.0;
};

Tracked tracked(double value);
Tracked operator+(Tracked x, Tracked y);
Tracked operator-(Tracked x, Tracked y);
Tracked operator*(Tracked x, Tracked y);

// Coefficients of 1, x, x^2, ...
struct Polynomial {
    int degree = 0;
    std::array<Tracked, largest_degree + 1> coefficients{};
};

Polynomial polynomial(std::initializer_list<double> coefficients);
Polynomial operator+(const Polynomial& p, const Polynomial& q);
Polynomial operator-(const Polynomial& p, const Polynomial& q);
Polynomial operator*(const Polynomial& p, const Polynomial& q);
Polynomial operator*(double factor, const Polynomial& p);
Polynomial derivative(const Polynomial& p);

// Bernstein coefficients on [0, 1]: their least and largest bound the polynomial.
struct Bernstein {
    int degree = 0;
    std::array<Tracked, largest_degree + 1> coefficients{};
};

Bernstein bernstein(const Polynomial& p);
Tracked evaluate(const Bernstein& p, double x);

enum class Sign { positive, negative, undecided };

// The sign of a computed number whose rounding margin is known.
Sign sign(Tracked value);

// positive: everywhere on [0, 1]; negative: somewhere, provably; undecided: rounding cannot tell.
Sign sign_on_unit_interval(const Bernstein& p);

// All places in [0, 1] where p changes sign or may touch zero, ascending.
std::vector<double> roots_on_unit_interval(const Bernstein& p);

}  // namespace rolling_ellipse
