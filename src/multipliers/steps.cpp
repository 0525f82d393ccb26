#include "multipliers/steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "integrator/implicit.hpp"
#include "integrator/runge_kutta.hpp"
#include "rolling/stepped/steps.hpp"

namespace rolling_ellipse {
namespace {

template <int N>
CoordinateState state_of(const Vector<N>& y) {
    return {y.template head<5>(), y.template segment<5>(5)};
}

// The index-1 system for y = (q, q_dot).
struct IndexOne {
    static constexpr int size = 10;
    const SteppedMultipliers& motion;

    Vector<10> operator()(double, const Vector<10>& y) const {
        const CoordinateState state = state_of<10>(y);
        Vector<10> rate;
        rate << state.q_dot, accelerations(motion.body, motion.settings, state).q_ddot;
        return rate;
    }
};

// The stabilised index-2 equations divided by the mass, after C. W. Gear, B. Leimkuhler, G. K.
// Gupta, J. Comput. Appl. Math. 12-13 (1985) 77, for y = (q, v, lambda, mu). G consists of the rows
// of A for the position constraints:
//     q_dot = v + G^T mu,   M v_dot = Q + A^T lambda,   0 = A v,   0 = (f2, f3, f4)
struct IndexTwo {
    static constexpr int size = 17;
    const SteppedMultipliers& motion;

    Vector<17> operator()(double, const Vector<17>& y) const {
        const ConstrainedBody& body = motion.body;
        const Coordinates q = y.head<5>();
        const Coordinates v = y.segment<5>(5);
        const ConstraintMatrix a = constraint_matrix(body.axes(), q);
        Vector<17> rate;
        rate << v + a.bottomRows<3>().transpose() * y.tail<3>(),
            body.specific_force() + a.transpose() * y.segment<4>(10), a * v,
            position_residuals(body.axes(), q);
        return rate;
    }

    Vector<17> mass() const {
        Vector<17> mass = Vector<17>::Zero();
        mass.head<5>().setOnes();
        mass.segment<5>(5) = motion.body.specific_mass();
        return mass;
    }

    Vector<17> typical() const {
        const double length = motion.body.length();
        const double gravity = motion.body.specific_force().norm();
        const double rate = std::sqrt(gravity / length);
        Vector<17> typical;
        typical << length, length, 1.0, 1.0, length, rate * length, rate * length, rate, rate,
            rate * length, gravity, gravity, gravity, gravity * length, rate, rate, rate * length;
        return typical;
    }

    // The Jacobian, from finite differences in q, which are accurate enough for simplified Newton
    // iteration; all other terms are linear.
    Matrix<17> jacobian(double t, const Vector<17>& y) const {
        const double length = motion.body.length();
        const Coordinates unit{length, length, 1.0, 1.0, length};
        const ConstraintMatrix a = constraint_matrix(motion.body.axes(), y.head<5>());
        const Vector<17> here = (*this)(t, y);
        Matrix<17> jacobian = Matrix<17>::Zero();
        for (int i = 0; i < 5; ++i) {
            Vector<17> moved = y;
            moved[i] += std::sqrt(epsilon) * unit[i];
            jacobian.col(i) = ((*this)(t, moved) - here) / (moved[i] - y[i]);
        }
        jacobian.block<5, 5>(0, 5).setIdentity();
        jacobian.block<5, 3>(0, 14) = a.bottomRows<3>().transpose();
        jacobian.block<5, 4>(5, 10) = a.transpose();
        jacobian.block<4, 5>(10, 5) = a;
        return jacobian;
    }
};

// The result of one step of size 1 for y' = z y, starting from y = 1.
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

// Calls action(integrator, steps) with the integrator and the steps of a motion.
template <class Motion, class Action>
void with_integrator(Motion& motion, Action action) {
    if (auto* steps = std::get_if<Steps<17>>(&motion.steps)) {
        const IndexTwo f{motion};
        return action(Radau<IndexTwo>(f), *steps);
    }
    auto& steps = std::get<Steps<10>>(motion.steps);
    const IndexOne f{motion};
    with_tableau(motion.settings.method, [&](auto tableau) {
        action(ExplicitMethod<decltype(tableau), IndexOne>(f), steps);
    });
}

SteppedMultipliers motion_from(const Scene& scene, const CoordinateStart& start,
                               const Settings& settings) {
    const ConstrainedBody body(scene);
    const auto& [q, q_dot] = start.state;
    SteppedMultipliers motion{body,    settings,         body.specific_energy(start.state).total(),
                              start.x, start.angle_base, {}};
    const double size = settings.step.value_or(0.0);
    if (settings.stabilization == Stabilization::ggl) {
        Vector<17> y;
        y << q, q_dot, body.solve(start.state).multipliers / scene.mass, Eigen::Vector3d::Zero();
        motion.steps = Steps<17>{size, {{0.0, y, Vector<17>::Zero(), 0.0}}};
    } else {
        Vector<10> y;
        y << q, q_dot;
        motion.steps = Steps<10>{size, {{0.0, y, Vector<10>::Zero(), 0.0}}};
    }
    return motion;
}

bool projects(const SteppedMultipliers& motion) {
    return motion.settings.stabilization == Stabilization::projection ||
           motion.settings.stabilization == Stabilization::projection_energy;
}

// Projects a state as the stabilization prescribes; returns the largest residual before the
// projection.
double project(const SteppedMultipliers& motion, CoordinateState& state) {
    const bool by_energy = motion.settings.stabilization == Stabilization::projection_energy;
    return by_energy ? motion.body.project(state, motion.specific_energy)
                     : motion.body.project(state);
}

template <int N>
AfterStep adjust(SteppedMultipliers& motion, Point<N>& point) {
    if (!projects(motion)) return AfterStep::unchanged;
    CoordinateState state = state_of<N>(point.y);
    motion.most_projected = std::fmax(motion.most_projected, project(motion, state));
    point.y.template head<10>() << state.q, state.q_dot;
    point.carry.setZero();
    return AfterStep::changed;
}

template <int N>
double reduce(Point<N>& point) {
    using namespace coordinate;
    const double half_turns = take_half_turns_off(point.y[theta], point.carry[theta]);
    if (half_turns == 0) return 0.0;
    const DoubleDouble rest = DoubleDouble{point.y[psi], point.carry[psi]} - half_turn * half_turns;
    point.y[psi] = rest.high;
    point.carry[psi] = rest.low;
    point.origin[theta] += half_turns * pi;
    point.origin[psi] += half_turns * pi;
    return half_turns;
}

// The state at a knot plus a change; its angles omit the half turns of the knot.
template <int N>
CoordinateState state_at(const SteppedMultipliers& motion, const Knot<N>& knot,
                         const Vector<N>& change) {
    CoordinateState state = state_of<N>(knot.y + (knot.carry + change));
    if (projects(motion) && !change.isZero(0)) project(motion, state);
    return state;
}

}  // namespace

CoordinateStart coordinate_start(const Scene& scene, const State& start) {
    const double rest = within_a_turn(start.theta);
    const CoordinateState state = kinematics(scene.axes(), rest, start.omega);
    CoordinateStart result{state, start.x, two_sum(start.theta, -rest), start.mode == Mode::rest};
    result.state.q[coordinate::x] = 0.0;
    return result;
}

CoordinateStart coordinate_start(const CoordinateState& state) {
    const double theta = state.q[coordinate::theta];
    const double rest = within_a_turn(theta);
    CoordinateStart result{state, state.q[coordinate::x], two_sum(theta, -rest)};
    result.state.q[coordinate::x] = 0.0;
    result.state.q[coordinate::theta] = rest;
    result.state.q[coordinate::psi] =
        static_cast<double>(DoubleDouble{state.q[coordinate::psi], 0.0} - result.angle_base);
    return result;
}

Integration<SteppedMultipliers> integrate_multipliers(const Scene& scene,
                                                      const CoordinateStart& start,
                                                      const Settings& settings, double t_end,
                                                      const Checkpoint& checkpoint) {
    Integration<SteppedMultipliers> result{motion_from(scene, start, settings)};
    result.followed_until = t_end;
    if (start.rests) return result;
    SteppedMultipliers& motion = result.motion;
    with_integrator(motion, [&](auto integrator, auto& steps) {
        result.ending = integrate(
            integrator, steps, {settings.rtol, settings.atol}, settings.max_steps, t_end,
            [&](auto& point) { return adjust(motion, point); },
            [](auto& point) { return reduce(point); }, checkpoint);
        result.counts = integrator.counts;
        result.followed_until = steps.knots.back().t;
    });
    return result;
}

void sample(const SteppedMultipliers& motion, const double* times, std::size_t n,
            CoordinateState* samples) {
    with_integrator(motion, [&](auto integrator, const auto& steps) {
        sample_steps(
            integrator, steps, times, n, [&](std::size_t i, const auto& knot, const auto& change) {
                CoordinateState state = state_at(motion, knot, change);
                for (const int angle : {coordinate::theta, coordinate::psi}) {
                    const DoubleDouble rest = two_sum(state.q[angle], 0.0);
                    state.q[angle] =
                        static_cast<double>(motion.angle_base + half_turn * knot.periods + rest);
                }
                state.q[coordinate::x] += motion.x_base;
                samples[i] = state;
            });
    });
}

std::vector<Invariants> invariants(const SteppedMultipliers& motion, long evaluations) {
    std::vector<Invariants> points;
    with_integrator(motion, [&](auto integrator, const auto& steps) {
        survey(integrator, steps, evaluations, [&](const auto& knot, const auto& change) {
            const CoordinateState state = state_at(motion, knot, change);
            points.push_back(
                {motion.body.specific_energy(state), motion.body.largest_residual(state.q)});
        });
    });
    return points;
}

// Baumgarte's feedback (J. Baumgarte, Comput. Methods Appl. Mech. Eng. 1 (1972) 1): f'' + 2 alpha
// f' + beta^2 f = 0 for the position constraints, f1' + 2 alpha f1 = 0 for the velocity.
MultiplierSolution accelerations(const ConstrainedBody& body, const Settings& settings,
                                 const CoordinateState& state) {
    if (settings.stabilization != Stabilization::baumgarte) return body.solve(state);
    const Axes& axes = body.axes();
    const auto [alpha, beta] = settings.baumgarte;
    Eigen::Vector4d demand = -constraint_drift(axes, state.q, state.q_dot);
    demand -= 2 * alpha * (constraint_matrix(axes, state.q) * state.q_dot);
    demand.tail<3>() -= square(beta) * position_residuals(axes, state.q);
    return body.solve(state.q, demand);
}

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
