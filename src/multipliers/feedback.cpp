#include "multipliers/feedback.hpp"

#include <algorithm>
#include <array>
#include <complex>

#include "rolling/stepped/steps.hpp"

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

}  // namespace

double feedback_growth(const Settings& settings) {
    if (settings.stabilization != Stabilization::baumgarte || !settings.step) return 0.0;
    const double alpha = settings.baumgarte[0];
    const double beta = settings.baumgarte[1];
    const std::complex<double> split =
        std::sqrt(std::complex<double>(square(alpha) - square(beta)));
    return with_tableau(settings.method, [&](auto tableau) {
        double largest = 0.0;
        for (const std::complex<double> root :
             {-alpha + split, -alpha - split, std::complex<double>(-2 * alpha)}) {
            const auto factor = stability_function<decltype(tableau)>(root * *settings.step);
            largest = std::max(largest, std::abs(factor));
        }
        return largest;
    });
}

}  // namespace rolling_ellipse
