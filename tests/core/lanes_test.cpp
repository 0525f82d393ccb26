// Compares the functions of numerics/lanes.hpp, at the narrowest level, with the C library in long
// double. tests/rolling/test_lanes.py shows that all levels give the same bits.

#include "numerics/lanes.hpp"

#include <cmath>
#include <cstdio>

using namespace rolling_ellipse;

namespace {

int failures = 0;

// Checks the largest error of a function, in ulp of the exact value, at points from low to high in
// geometric progression.
template <class Function, class Exact>
void within(double ulps, const char* what, double low, double high, const Function& function,
            const Exact& exact) {
    constexpr int places = 1'000'000;
    double worst = 0.0;
    for (int i = 0; i < places; i += lanes) {
        Pack x;
        for (int lane = 0; lane < lanes; ++lane) {
            x[lane] = low * std::pow(high / low, (i + lane) / (places - 1.0));
        }
        const Pack found = function(x);
        for (int lane = 0; lane < lanes; ++lane) {
            const long double expected = exact(static_cast<long double>(x[lane]));
            const double size = std::abs(static_cast<double>(expected));
            const double ulp = std::nextafter(size, INFINITY) - size;
            const double off = static_cast<double>(std::abs(found[lane] - expected)) / ulp;
            if (!(off <= worst)) worst = off;  // true for NaN, too
        }
    }
    const bool holds = worst <= ulps;
    std::printf("%-24s %.3f ulp%s\n", what, worst, holds ? "" : ", too much");
    if (!holds) ++failures;
}

}  // namespace

// The bounds allow half an ulp for the last rounding and half an ulp for each earlier step, a
// quotient or a sum of two terms of similar size: up to three steps, four in sinh, five in asinh.
int main() {
    within(
        2.5, "sinh", 1e-300, 20.0, [](Pack v) { return hyperbolic(v).sinh; },
        [](long double v) { return std::sinh(v); });
    within(
        1.5, "e^-v", 1e-10, 40.0, [](Pack v) { return hyperbolic(v).falling; },
        [](long double v) { return std::exp(-v); });
    within(
        1.5, "log", 1.42, 1e8, [](Pack x) { return log(x); },
        [](long double x) { return std::log(x); });
    within(
        2.0, "log beside 1", 1 + 1e-12, 1.42, [](Pack x) { return log(x); },
        [](long double x) { return std::log(x); });
    within(
        3.0, "asinh", 1e-150, 1e100, [](Pack x) { return asinh(x); },
        [](long double x) { return std::asinh(x); });
    within(
        2.0, "angle", 1e-300, 1.0, [](Pack s) { return octant_angle(s, pack(1.0)); },
        [](long double s) { return std::atan(s); });
    within(
        2.0, "obtuse angle", 1e-150, 1e150, [](Pack s) { return angle_of(s, pack(-1.0)); },
        [](long double s) { return std::atan2(s, -1.0L); });
    within(
        0.5, "two_product", 1e-100, 1e100,
        [](Pack x) {
            const PackPair product = two_product(x, pack(1 / 3.0));
            return product.low + product.high;
        },
        [](long double x) { return x * (1 / 3.0); });
    std::printf(failures == 0 ? "all hold\n" : "%d do not hold\n", failures);
    return failures == 0 ? 0 : 1;
}
