// Boost.odeint on the rolling ellipse, called by boost_odeint.py through ctypes.
#include <array>
#include <boost/numeric/odeint.hpp>
#include <boost/version.hpp>
#include <cmath>

namespace {

namespace odeint = boost::numeric::odeint;
using State = std::array<double, 3>;  // theta [rad], omega [rad/s], x [m]
using Algebra = odeint::array_algebra;

constexpr long most_steps = 1'000'000;

struct Problem {
    double b2, spread, a2b2, total, gamma, sigma, gyration2;  // Problem.body of problem.py
    double theta, omega, x;
    double t_end, rtol, atol, pace;
};

struct Counts {
    long steps = 0, rejected = 0, evaluations = 0;
};

enum Answer { done = 0, too_many_steps = 1, no_progress = 2, unknown_stepper = 3 };

struct Rates {
    const Problem& body;
    Counts& counts;

    void operator()(const State& y, State& rate, double) const {
        ++counts.evaluations;
        const double s = std::sin(y[0]), c = std::cos(y[0]), omega = y[1];
        const double u = body.b2 + body.spread * s * s, h = std::sqrt(u), hu = h * u;
        const double load = body.gamma * hu + body.a2b2 * omega * omega;
        const double turn = body.sigma * hu * u - body.spread * s * c * load;
        rate[0] = omega;
        rate[1] = turn / (u * (body.total * u - body.a2b2));
        rate[2] = h * omega;
    }
};

struct Samples {
    const double* times;
    double* states;  // theta, omega and x of each sample
    long count;

    void put(long i, const State& y) const { std::copy(y.begin(), y.end(), states + 3 * i); }
};

// Runs a controlled stepper that stops at every sample. After a step that a sample cuts short, the
// next step size is the larger of the one before the cut and the one that the stepper proposes.
template <class Stepper>
Answer stop_at(Stepper stepper, const Rates& rates, double step, const Samples& samples) {
    State y{rates.body.theta, rates.body.omega, rates.body.x};
    double t = 0;
    for (long i = 0; i < samples.count; ++i) {
        const double stop = samples.times[i];
        while (t < stop) {
            const bool last = t + step >= stop;
            double next = last ? stop - t : step;
            if (stepper.try_step(rates, y, t, next) == odeint::success) {
                ++rates.counts.steps;
                if (last) t = stop;
                step = last ? std::max(step, next) : next;
            } else {
                ++rates.counts.rejected;
                step = next;
                if (!(t + step > t)) return no_progress;
            }
            if (rates.counts.steps + rates.counts.rejected > most_steps) return too_many_steps;
        }
        samples.put(i, y);
    }
    return done;
}

// Runs a stepper with dense output, which interpolates each sample in the step that contains it.
template <class Stepper>
Answer interpolate(Stepper stepper, const Rates& rates, double step, const Samples& samples) {
    State y{rates.body.theta, rates.body.omega, rates.body.x};
    stepper.initialize(y, 0.0, step);
    for (long i = 0; i < samples.count; ++i) {
        const double t = samples.times[i];
        if (t <= 0) {
            samples.put(i, y);
            continue;
        }
        while (stepper.current_time() < t) {
            stepper.do_step(rates);
            if (++rates.counts.steps > most_steps) return too_many_steps;
        }
        State found;
        stepper.calc_state(t, found);
        samples.put(i, found);
    }
    return done;
}

template <template <class, class, class, class, class, class, class> class Pair>
using Of = Pair<State, double, State, double, Algebra, odeint::default_operations,
                odeint::initially_resizer>;

template <class Pair>
Answer controlled(const Rates& rates, int order, const Samples& samples) {
    const Problem& given = rates.body;
    const double step = given.pace * std::pow(given.rtol, 1.0 / (order + 1));
    return stop_at(odeint::make_controlled(given.atol, given.rtol, Pair()), rates, step, samples);
}

Answer chosen(int stepper, bool dense, const Rates& rates, const Samples& samples) {
    using Dopri5 = Of<odeint::runge_kutta_dopri5>;
    const Problem& given = rates.body;
    switch (stepper) {
        case 0:
            if (!dense) return controlled<Dopri5>(rates, 5, samples);
            return interpolate(odeint::make_dense_output(given.atol, given.rtol, Dopri5()), rates,
                               given.pace * std::pow(given.rtol, 1.0 / 6), samples);
        case 1:
            return controlled<Of<odeint::runge_kutta_fehlberg78>>(rates, 8, samples);
        case 2:
            return controlled<Of<odeint::runge_kutta_cash_karp54>>(rates, 5, samples);
        case 3: {
            Of<odeint::bulirsch_stoer> steps(given.atol, given.rtol, 1.0, 1.0);
            return stop_at(steps, rates, given.pace * std::pow(given.rtol, 1.0 / 9), samples);
        }
    }
    return unknown_stepper;
}

}  // namespace

extern "C" {

const char* boost_version = BOOST_LIB_VERSION;

int roll(int stepper, int dense, const Problem* given, long count, const double* times,
         double* states, long* counted) {
    Counts counts;
    Answer answer;
    try {
        answer = chosen(stepper, dense != 0, Rates{*given, counts}, {times, states, count});
    } catch (const odeint::odeint_error&) {
        answer = no_progress;
    }
    counted[0] = counts.steps;
    counted[1] = counts.rejected;
    counted[2] = counts.evaluations;
    return answer;
}

}  // extern "C"
