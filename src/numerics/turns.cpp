#include "numerics/turns.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "numerics/lu.hpp"
#include "numerics/polynomial.hpp"

namespace rolling_ellipse {
namespace {

// Degree of the fitted polynomials. Dense output, of degree 7 at most, needs no halving of its
// intervals; other quantities may need several.
constexpr int degree = 8;

// Chebyshev nodes on [0, 1], to four digits, and between them, at index `compared`, one more point,
// at which the polynomial is compared with the quantity.
constexpr std::array<double, degree + 2> places = {0.0076, 0.067, 0.1786, 0.329, 0.41,
                                                   0.5,    0.671, 0.8214, 0.933, 0.9924};
constexpr int compared = 4;

// The values at s of the Bernstein polynomials binomial(degree, i) s^i (1-s)^(degree-i).
Eigen::Matrix<double, degree + 1, 1> bernstein_basis(double s) {
    constexpr auto binomial = binomials<degree>();
    Eigen::Matrix<double, degree + 1, 1> row;
    for (int i = 0; i <= degree; ++i) {
        row[i] = binomial[i];
        for (int k = 0; k < degree; ++k) row[i] *= k < i ? s : 1 - s;
    }
    return row;
}

// The Bernstein coefficients of the polynomial through the values at the nodes.
Eigen::Matrix<double, degree + 1, 1> coefficients(const double* values) {
    using Matrix = Eigen::Matrix<double, degree + 1, degree + 1>;
    const auto node = [](int i) { return i < compared ? i : i + 1; };
    static const LU<double, degree + 1> basis = [&] {
        Matrix matrix;
        for (int i = 0; i <= degree; ++i) {
            matrix.row(i) = bernstein_basis(places[node(i)]).transpose();
        }
        return LU<double, degree + 1>(matrix);
    }();
    Eigen::Matrix<double, degree + 1, 1> at_nodes;
    for (int i = 0; i <= degree; ++i) at_nodes[i] = values[node(i)];
    return basis.solve(at_nodes);
}

struct Part {
    double low;
    double high;
    int depth = 0;
};

// Adds the turning points in the given intervals, and the middle of each interval that is halved.
// Returns false if some polynomial does not fit the quantity.
bool add_turns_in(const Measure& measure, double size, std::vector<Part> parts,
                  std::vector<double>& times) {
    constexpr double roundings = 1000;  // allowed rounding errors; the inverse basis has norm 230
    constexpr int deepest = 16;
    std::size_t halvings = 64 * parts.size();  // a limit, since halving does not reduce noise
    bool all_met = true;
    while (!parts.empty()) {
        std::vector<double> at;
        at.reserve(parts.size() * places.size());
        for (const Part& part : parts) {
            for (const double s : places) at.push_back(part.low + (part.high - part.low) * s);
        }
        const std::vector<double> values = measure(at);
        std::vector<Part> halves;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto& [low, high, depth] = parts[i];
            const double* const here = values.data() + i * places.size();
            const auto bernstein = coefficients(here);
            const double missed =
                std::abs(bernstein_basis(places[compared]).dot(bernstein) - here[compared]);
            const auto [least, most] = std::minmax_element(here, here + places.size());
            const double noise =
                epsilon * (roundings * size + 8 * high / (high - low) * (*most - *least));
            if (missed > noise) {
                const double middle = low + 0.5 * (high - low);
                if (depth < deepest && low < middle && middle < high && halvings > 0) {
                    --halvings;
                    halves.push_back({low, middle, depth + 1});
                    halves.push_back({middle, high, depth + 1});
                    times.push_back(middle);
                    continue;
                }
                all_met = false;
            }
            Bernstein<degree - 1> rate;
            for (int k = 0; k < degree; ++k) {
                rate.coefficients[k] = {bernstein[k + 1] - bernstein[k], 0.0};
                rate.coefficients[k].magnitude = noise / margin({0.0, 1.0});
            }
            for (const double s : roots_on_unit_interval(rate)) {
                times.push_back(low + (high - low) * s);
            }
        }
        parts = std::move(halves);
    }
    return all_met;
}

}  // namespace

void sort_once(std::vector<double>& times) {
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
}

bool add_turns(const Measure& measure, double length, std::vector<double>& times) {
    constexpr std::size_t together = 1024;
    double size = length;
    for (const double value : measure(times)) size = std::max(size, std::abs(value));
    bool all_met = true;
    const std::vector<double> ends = times;
    for (std::size_t i = 0; i + 1 < ends.size(); i += together) {
        std::vector<Part> parts;
        for (std::size_t k = i; k + 1 < ends.size() && k < i + together; ++k) {
            parts.push_back({ends[k], ends[k + 1]});
        }
        all_met &= add_turns_in(measure, size, std::move(parts), times);
    }
    sort_once(times);
    return all_met;
}

}  // namespace rolling_ellipse
