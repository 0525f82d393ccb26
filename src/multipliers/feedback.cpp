#include "multipliers/feedback.hpp"

#include <algorithm>
#include <array>
#include <complex>

#include "integrator/explicit_tableaus.hpp"
#include "numerics/numbers.hpp"

namespace rolling_ellipse {
namespace {

// The result of one step of size 1 of y' = z y from y = 1.
template <class Tableau>
std::complex<double> stability_function(std::complex<double> z) {
    std::array<std::complex<double>, Tableau::stages> slopes;
    std::complex<double> y;
    for (int i = 0; i <= Tableau::stages; ++i) {
        y = 1.0;
        for (int j = 0; j < i; ++j) y += Tableau::a[i][j] * slopes[j];
        if (i < Tableau::stages) slopes[i] = z * y;
    }
    return y;
}

template <class Tableau>
double largest_factor(double alpha, double beta, double step) {
    const std::complex<double> split =
        std::sqrt(std::complex<double>(square(alpha) - square(beta)));
    double largest = 0.0;
    for (const std::complex<double> root :
         {-alpha + split, -alpha - split, std::complex<double>(-2 * alpha)}) {
        largest = std::max(largest, std::abs(stability_function<Tableau>(root * step)));
    }
    return largest;
}

}  // namespace

double feedback_growth(const Settings& settings) {
    if (settings.stabilization != Stabilization::baumgarte || !settings.step) return 0.0;
    const auto [alpha, beta] = settings.baumgarte;
    switch (settings.method) {
        case Method::rk4:
            return largest_factor<RungeKutta4>(alpha, beta, *settings.step);
        case Method::dopri5:
            return largest_factor<DormandPrince5>(alpha, beta, *settings.step);
        default:
            return largest_factor<DormandPrince853>(alpha, beta, *settings.step);
    }
}

}  // namespace rolling_ellipse
