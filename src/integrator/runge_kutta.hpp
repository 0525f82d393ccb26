// Explicit Runge-Kutta methods: fixed steps, error-controlled steps, dense output. HNW: E. Hairer,
// S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed.
#pragma once

#include <algorithm>
#include <array>
#include <type_traits>

#include "integrator/explicit_tableaus.hpp"
#include "integrator/system.hpp"

namespace rolling_ellipse {

// Calls action(i) for First <= i < End, each i an integral_constant.
template <int First, int End, class Action>
[[gnu::always_inline]] inline void unrolled(const Action& action) {
    if constexpr (First < End) {
        action(std::integral_constant<int, First>{});
        unrolled<First + 1, End>(action);
    }
}

// The sum of the first Count stages with the weights of a row; terms of zero weight are removed at
// compile time. Written component by component, since Eigen's vector expressions are not inlined
// here.
template <const auto& Table, int Row, int Count, int N, std::size_t Size>
[[gnu::always_inline]] inline Vector<N> weighted_sum(const std::array<Vector<N>, Size>& k) {
    Vector<N> sum = Vector<N>::Zero();
    unrolled<0, Count>([&](auto stage) __attribute__((always_inline)) {
        if constexpr (constexpr double weight = Table[Row][stage]; weight != 0.0) {
            for (int i = 0; i < N; ++i) sum[i] += weight * k[stage][i];
        }
    });
    return sum;
}

template <class Tableau, class System>
class ExplicitMethod {
  public:
    static constexpr int N = System::size;
    static constexpr bool controls_error = Tableau::error_estimates > 0;
    static constexpr int all_stages = Tableau::all_stages;
    using Dense = DenseOutput<N, Tableau::dense_terms>;
    // True if an error-controlled step computes every stage of its dense output.
    static constexpr bool keeps_dense = controls_error && all_stages == Tableau::stages + 1;

    explicit ExplicitMethod(const System& system) : f_(system) {}

    StepCounts counts;
    Dense last_dense;  // dense output of the last error-controlled step, if keeps_dense

    // Takes a step of the given size; always returns true.
    bool advance(Point<N>& point, double h) {
        evaluate<0, Tableau::stages>(point, h);
        add<N>(point, increment(h));
        return true;
    }

    // The dense output of the step of size h from a point.
    Dense dense_output(const Point<N>& from, double h) {
        evaluate<0, all_stages>(from, h);
        return dense_of_stages(h);
    }

    // Takes error-controlled steps up to t_end; `visit(point)` is called with each new point and
    // may change it. The controller is the elementary one of HNW II.4 with SciPy's limits on
    // growth.
    template <class Visit>
    Ending integrate(Point<N> point, double t_end, const Tolerance& tolerance, long max_steps,
                     Visit visit) {
        constexpr double safety = 0.9;
        constexpr double most_shrinking = 0.2;
        constexpr double most_growth = 10.0;
        if (!(point.t < t_end)) return Ending::completed;
        evaluate<0, 1>(point, 0.0);
        double h = starting_step(point, t_end, tolerance);
        for (long n = 0; n < max_steps; ++n) {
            double growth_limit = most_growth;
            for (;;) {
                const double smallest = 10 * (std::nextafter(point.t, infinity) - point.t);
                if (!(h >= smallest)) return Ending::step_too_small;
                const double t = std::min(point.t + h, t_end);
                h = t - point.t;  // the step between the rounded times
                evaluate<1, error_stages>(point, h);
                Point<N> next = point;
                add<N>(next, increment(h));
                const double error =
                    in_range<N>(next.y) ? error_square(point, next, h, tolerance) : infinity;
                const double factor = safety * std::pow(error, -0.5 / Tableau::order);
                if (error < 1) {
                    evaluate<error_stages, Tableau::stages + 1>(point, h);
                    if constexpr (keeps_dense) last_dense = dense_of_stages(h);
                    point = next;
                    point.t = t;
                    h *= std::min(growth_limit, factor);
                    break;
                }
                h *= std::max(most_shrinking, factor);  // most_shrinking if the error is NaN
                growth_limit = 1.0;
                ++counts.rejected;
            }
            const AfterStep next = visit(point);
            if (!(point.t < t_end)) return Ending::completed;
            if (next == AfterStep::changed) {
                evaluate<0, 1>(point, 0.0);
            } else {
                k_[0] = k_[Tableau::stages];
            }
        }
        return Ending::max_steps;
    }

  private:
    Dense dense_of_stages(double h) const {
        const Vector<N> change = increment(h);
        const Vector<N>& slope_before = k_[0];
        const Vector<N>& slope_after = k_[Tableau::stages];
        Dense dense;
        dense.terms[0] = change;
        dense.terms[1] = h * slope_before - change;
        dense.terms[2] = 2 * change - h * (slope_before + slope_after);
        unrolled<0, Tableau::dense_terms>([&](auto term) {
            dense.terms[3 + term] = h * weighted_sum<Tableau::dense, term, all_stages>(k_);
        });
        for (Vector<N>& term : dense.terms) {
            // Omits terms that are out of range because a stage overflowed.
            if (!in_range<N>(term)) term.setZero();
        }
        return dense;
    }

    // Number of stages in the error estimate, including f at the end of the step if its weight is
    // not 0.
    static constexpr int error_stages =
        Tableau::stages + (Tableau::error[0][Tableau::stages] != 0.0 ? 1 : 0);

    // Sums the earlier stages independently of the last one, so that the processor can compute both
    // at the same time.
    template <int Stage>
    [[gnu::always_inline]] void evaluate_stage(const Point<N>& from, double h) {
        Vector<N> change = from.carry;
        if constexpr (Stage > 0) {
            const Vector<N> known = weighted_sum<Tableau::a, Stage, Stage - 1>(k_);
            const double share = h * Tableau::a[Stage][Stage - 1];
            for (int i = 0; i < N; ++i) {
                change[i] = (change[i] + h * known[i]) + share * k_[Stage - 1][i];
            }
        }
        k_[Stage] = f_(from.t + Tableau::c[Stage] * h, from.y + change);
        ++counts.evaluations;
    }

    template <int First, int End>
    void evaluate(const Point<N>& from, double h) {
        unrolled<First, End>([&](auto stage) { evaluate_stage<stage>(from, h); });
    }

    Vector<N> increment(double h) const {
        return h * weighted_sum<Tableau::a, Tableau::stages, all_stages>(k_);
    }

    // The inverse scales 1/(atol + rtol size) that multiply the errors; infinite where
    // atol + rtol size is 0.
    static Vector<N> inverse_scale(const Tolerance& tolerance, const Vector<N>& size) {
        Vector<N> inverse;
        for (int i = 0; i < N; ++i) {
            inverse[i] = 1 / (tolerance.absolute + tolerance.relative * size[i]);
        }
        return inverse;
    }

    // The mean square of v relative to the tolerance. A component that is 0 contributes 0 even
    // where the tolerance is 0.
    [[gnu::always_inline]] static double mean_square(const Vector<N>& v, const Vector<N>& inverse) {
        double sum = 0.0;
        for (int i = 0; i < N; ++i) {
            sum += v[i] != 0.0 ? square(v[i] * inverse[i]) : 0.0;
        }
        return sum / N;
    }

    // The mean square of a step's error relative to the tolerance; its root is not needed.
    [[gnu::always_inline]] double error_square(const Point<N>& before, const Point<N>& after,
                                               double h, const Tolerance& tolerance) const {
        Vector<N> size;
        for (int i = 0; i < N; ++i) {
            size[i] = std::max(std::abs(before.origin[i] + before.y[i]),
                               std::abs(after.origin[i] + after.y[i]));
        }
        const Vector<N> inverse = inverse_scale(tolerance, size);
        const double error = mean_square(weighted_sum<Tableau::error, 0, all_stages>(k_), inverse);
        if constexpr (Tableau::error_estimates == 1) {
            return h * h * error;
        } else {  // HNW II.10: the estimate of order 5, damped by that of order 3
            const double rough =
                mean_square(weighted_sum<Tableau::error, 1, all_stages>(k_), inverse);
            return error == 0.0 ? 0.0 : h * h * error * (error / (error + 0.01 * rough));
        }
    }

    // Size of the first step, from the magnitudes of y, y' and y'': HNW II.4.
    double starting_step(const Point<N>& point, double t_end, const Tolerance& tolerance) {
        // Replaces an infinite span: no factor could shorten an infinite step.
        constexpr double longest = 1e300;
        const double span = std::min(t_end - point.t, longest);
        const Vector<N> size = (point.origin + point.y).cwiseAbs();
        const Vector<N> inverse = inverse_scale(tolerance, size);
        const auto norm = [&](const Vector<N>& v) { return std::sqrt(mean_square(v, inverse)); };
        const double d0 = norm(size);
        const double d1 = norm(k_[0]);
        double h0 = d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01 * d0 / d1;
        if (!(h0 > 0.0 && h0 < span)) h0 = span;
        const Vector<N> slope = f_(point.t + h0, point.y + h0 * k_[0]);
        ++counts.evaluations;
        const double d2 = norm(slope - k_[0]) / h0;
        const double h1 = d1 <= 1e-15 && d2 <= 1e-15
                              ? std::max(1e-6, 1e-3 * h0)
                              : std::pow(0.01 / std::max(d1, d2), 1.0 / Tableau::order);
        const double h = std::min({100 * h0, h1, span});
        return h > 0.0 ? h : h0;
    }

    const System& f_;
    std::array<Vector<N>, all_stages> k_;
};

}  // namespace rolling_ellipse
