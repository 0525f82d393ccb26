// Tests parts of the core that Python does not call, and the use of the core in a C++ program.
//
//     cmake --preset release && cmake --build --preset release && ctest --preset release

#include <cmath>
#include <complex>
#include <cstdio>
#include <vector>

#include "motions.hpp"
#include "numerics/bisect.hpp"
#include "numerics/lu.hpp"
#include "numerics/numbers.hpp"
#include "numerics/polynomial.hpp"
#include "proof/law.hpp"
#include "rolling/level/kernel.hpp"
#include "simulate.hpp"

using namespace rolling_ellipse;

namespace {

int failures = 0;

void check(bool holds, const char* what, int line) {
    if (holds) return;
    std::printf("line %d: %s\n", line, what);
    ++failures;
}
#define CHECK(...) check((__VA_ARGS__), #__VA_ARGS__, __LINE__)

void a_double_double_keeps_what_rounding_takes() {
    const DoubleDouble sum = two_sum(1.0, 0x1p-80);
    CHECK(sum.high == 1.0 && sum.low == 0x1p-80);
    const DoubleDouble product = two_product(1 + epsilon, 1 + epsilon);  // 1 + 2 eps + eps^2
    CHECK(product.high == 1 + 2 * epsilon && product.low == epsilon * epsilon);
}

void bisection_ends_at_neighbours() {
    const Bracket root = bisect(1.0, 2.0, [](double x) { return x * x >= 2; });
    CHECK(root.high == std::nextafter(root.low, 2.0));
    CHECK(root.low * root.low < 2 && root.high * root.high >= 2);
}

void bisection_by_secants_ends_at_the_same_neighbours() {
    const auto f = [](double x) { return x * x * x - 2; };
    const Bracket slow = bisect(0.0, 4.0, [&](double x) { return f(x) > 0; });
    const Bracket quick = bisect_root(0.0, 4.0, f);
    CHECK(slow.low == quick.low && slow.high == quick.high);
    const Bracket falling = bisect_root(0.0, 4.0, [&](double x) { return -f(x); });
    CHECK(falling.high == std::nextafter(falling.low, 4.0));
    CHECK(f(falling.low) < 0 && f(falling.high) >= 0);
}

// The order of the rows makes pivoting necessary. All multipliers are 0 or 1/2, so that no
// operation rounds.
template <class Number>
void equations_are_solved_whatever_their_order(Number unit) {
    Eigen::Matrix<Number, 3, 3> rows;
    rows << 0, 4, 5, 2, 3, 8.5, 4, 2, 8;
    const Eigen::Matrix<Number, 3, 1> solution{1, -2, 3}, right{7, 21.5, 24};
    CHECK(LU<Number, 3>(unit * rows).solve(unit * right) == solution);
    CHECK(!LU<Number, 3>(0.0 * rows).solve(right).allFinite());
}

// The polynomial is negative between 0.25 and 0.75. With one constant added, it only touches zero;
// with a slightly smaller one, it is negative only near 0.5.
void the_first_place_where_a_polynomial_is_negative() {
    const Polynomial<2> dips = polynomial(-0.25, 1.0) * polynomial(-0.75, 1.0);
    const auto place = first_negative(bernstein(dips));
    CHECK(place && std::abs(*place - 0.25) <= 2 * epsilon);
    CHECK(!first_negative(bernstein(dips + polynomial(0.0625))));
    const auto grazes = first_negative(bernstein(dips + polynomial(0.0625 - 1e-12)));
    CHECK(grazes && std::abs(*grazes - (0.5 - 1e-6)) < 1e-9);
    // A polynomial that starts at zero and rises is not negative at its start; one that starts
    // below zero is.
    const auto later = first_negative(bernstein(polynomial(0.0, 1.0, -2.0)));
    CHECK(later && std::abs(*later - 0.5) <= 2 * epsilon);
    CHECK(first_negative(bernstein(polynomial(-1.0, 3.0))) == 0.0);
    CHECK(!first_negative(bernstein(polynomial(0.0, 0.0, 1.0))));
}

void a_polynomial_that_touches_zero_has_no_sign() {
    const Polynomial<1> x_minus_a_third = polynomial(-1.0 / 3, 1.0);
    const Polynomial<2> touches = x_minus_a_third * x_minus_a_third;
    CHECK(sign_on_unit_interval(bernstein(touches)) == Sign::undecided);
    CHECK(sign_on_unit_interval(bernstein(touches + polynomial(1e-9))) == Sign::positive);
    CHECK(sign_on_unit_interval(bernstein(touches - polynomial(1e-9))) != Sign::positive);
}

// Each segment provides coordinates, states and flow samples of the same motion. The body rolls,
// slides, leaves the ground and lands.
void every_segment_provides_every_kind_of_sample() {
    const Scene scene = bouncing(0.0, 5.5, 0.3);
    const Settings settings = settings_of(Model::automatic, Method::automatic);
    const Solution solution = simulate(scene, settings, 3.0, [] {});
    CHECK(solution.model == Model::contact && solution.ending == Ending::completed);
    CHECK(solution.motion.segments.size() > 3);
    const Sampler sampler(solution.motion, 301);
    std::vector<double> times;
    for (int i = 0; i <= 300; ++i) times.push_back(0.01 * i);
    std::vector<ContactSample> states(times.size());
    std::vector<FlowSample> flows(times.size());
    std::vector<CoordinateState> coordinates(times.size());
    sampler(times.data(), times.size(), states.data());
    sampler(times.data(), times.size(), flows.data());
    sampler(times.data(), times.size(), coordinates.data());
    for (std::size_t i = 0; i < times.size(); ++i) {
        using namespace coordinate;
        const State& state = states[i].state;
        const auto& [q, q_dot] = coordinates[i];
        // FlowSamples of rolling use a different formula.
        const auto close = [](double one, double other) {
            return std::abs(one - other) <= 1e-13 * (1 + std::abs(one));
        };
        CHECK(close(flows[i].theta, state.theta) && close(flows[i].omega, state.omega));
        CHECK(close(flows[i].x, state.x) && close(q[x], state.x) && close(q[z], state.z));
        CHECK(close(q_dot[x], state.x_dot) && close(q_dot[theta], state.omega));
        CHECK(position_residuals(scene.axes(), q).tail<2>().cwiseAbs().maxCoeff() < 1e-14);
    }
}

void needed_friction_of_special_forces() {
    CHECK(friction_needed({2.0, -1.0}) == 0.5);
    CHECK(friction_needed({0.0, 0.0}) == 0);
    CHECK(friction_needed({0.0, 1e-300}) == infinity);
    CHECK(friction_needed({-1.0, 0.0}) == infinity);
}

// Compares points, series and samples of motions between the kernels of all levels.
void every_vector_level_has_the_same_bits() {
    const Body body{2.0, 1.0, 1.25, 9.81};
    for (const double omega : {1.0, 3.2}) {  // libration and rotation
        const RollingFlow flow = rolling_flow(rolling_start(body, 0.2, omega));
        const FlowTable table = flow_table(flow).value();
        const PhaseIntegrand<double>& rate = flow.phase.integrand;
        const PhaseMap<double>& map = flow.phase.map;
        std::vector<double> times;
        for (int i = 0; i < 4003; ++i)
            times.push_back(std::sin(7.0 * i) * (i % 3 == 0 ? 1e9 : 5.0));
        constexpr int count = 11;
        std::vector<TablePlace> first_places;
        std::vector<FlowPiece> first_pieces;
        std::vector<double> first;
        for (const Kernel& kernel : kernels()) {
            std::vector<TablePlace> places(count);
            std::vector<FlowPiece> pieces(count);
            for (int i = 0; i < count; ++i) {
                places[i].y = 0.12 * i + 0.11;
                places[i].radius = 0.1;
            }
            kernel.states(rate, map, flow.amplitude, places.data(), count);
            kernel.series({0.25, 0.75, 1.0, rate.d0 / 16, rate.d1 / 16}, 0.5, 2.0, places.data(),
                          count, pieces.data());
            std::vector<double> read(3 * times.size());
            double* const theta = read.data();
            const FlowColumns out{theta, theta + times.size(), theta + 2 * times.size()};
            CHECK(!kernel.read(table.reader, times.data(), times.size(), out));
            if (first.empty()) {
                first_places = places;
                first_pieces = pieces;
                first = read;
            }
            CHECK(places[0].omega > 0 && pieces[count - 1].series.rows[2][2] != 0);
            CHECK(same_bits(places, first_places) && same_bits(pieces, first_pieces));
            CHECK(read == first);
        }
    }
}

}  // namespace

int main() {
    a_double_double_keeps_what_rounding_takes();
    bisection_ends_at_neighbours();
    bisection_by_secants_ends_at_the_same_neighbours();
    equations_are_solved_whatever_their_order(2.0);
    equations_are_solved_whatever_their_order(std::complex<double>(0.0, 2.0));
    the_first_place_where_a_polynomial_is_negative();
    a_polynomial_that_touches_zero_has_no_sign();
    every_segment_provides_every_kind_of_sample();
    needed_friction_of_special_forces();
    every_vector_level_has_the_same_bits();
    return verdict(failures);
}
