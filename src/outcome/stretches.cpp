#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "outcome/passages.hpp"

namespace rolling_ellipse {
namespace {

// The quantity at ascending times, from the cheapest type of sample that contains it.
void measure(const Motion& motion, const Sampler& sample, Quantity quantity, const double* times,
             std::size_t n, double* values) {
    const auto take = [&](auto kind, const auto& value) {
        std::vector<decltype(kind)> samples(n);
        sample(times, n, samples.data());
        std::transform(samples.begin(), samples.end(), values, value);
    };
    const Axes axes{motion.scene.a * motion.units.length, motion.scene.b * motion.units.length};
    const auto of_state = [&](double theta, double omega, double x, double z) {
        if (quantity == Quantity::theta) return theta;
        if (quantity == Quantity::x) return x;
        if (quantity == Quantity::z) return z;
        if (quantity == Quantity::omega) return omega;
        return x + geometry(axes, theta).dh;
    };
    if (std::holds_alternative<SteppedMultipliers>(motion.segments.front().law)) {
        using namespace coordinate;
        take(CoordinateState{}, [&](const CoordinateState& at) {
            return of_state(at.q[theta], at.q_dot[theta], at.q[x], at.q[z]);
        });
    } else if (quantity == Quantity::z) {
        take(ContactSample{}, [](const ContactSample& at) { return at.state.z; });
    } else {
        take(FlowSample{},
             [&](const FlowSample& at) { return of_state(at.theta, at.omega, at.x, 0.0); });
    }
}

// Properties of a segment for the search for turning points. Times are measured from the start of
// the segment, in units of the motion.
struct Course {
    const char* where;
    std::vector<DoubleDouble> knots = {};  // the motion is smooth between them
    bool monotone = false;                 // the observable is provably monotone between knots
    std::optional<DoubleDouble> period = {};
    double swung = 0.0;  // most quarter turns that a rocking body can make in a period
};

// Determines the course of a segment for one observable.
struct CourseOf {
    static constexpr const char* rolling = "while it rolls";
    static constexpr const char* resting = "while it rests";

    std::optional<Quantity> quantity;

    Course operator()(const RollingFlow& flow) const {
        const bool turns = flow.kind == MotionKind::rotation;
        const bool moves = turns || flow.kind == MotionKind::libration;
        Course course{flow.kind == MotionKind::rest ? resting : rolling};
        course.monotone = quantity && (!moves || (turns && is_along()));
        const DoubleDouble half = flow.phase.half_turn;
        if (moves && !std::isinf(half.high)) course.period = turns ? half : half * 2.0;
        course.swung = turns ? 0.0 : 4.0;
        return course;
    }

    Course operator()(const SlopeFlow& flow) const {
        const double unit = flow.body.time;  // a power of two, so that products with it are exact
        Course course{flow.rests ? resting : rolling};
        if (const auto half = half_period(flow)) {
            course.period = *half * 2.0 * unit;
            course.swung = 4.0;
            return course;
        }
        if (flow.turning) course.knots.push_back(*flow.turning);
        if (flow.acceleration != 0) {
            course.knots.push_back({-flow.start.omega / flow.acceleration, 0.0});
        }
        for (DoubleDouble& knot : course.knots) knot = knot * unit;
        course.monotone =
            quantity && (std::holds_alternative<Even>(flow.stretches.front().law) || is_along());
        return course;
    }

    Course operator()(const SteppedRolling& motion) const { return of_steps(motion.steps); }
    Course operator()(const SteppedMultipliers& motion) const {
        return std::visit([](const auto& steps) { return of_steps(steps); }, motion.steps);
    }

    Course operator()(const Slide& slide) const {
        Course found{"while it slides"};
        for (const SlidePiece& piece : slide.pieces) found.knots.push_back(piece.centre.time);
        return found;
    }

    Course operator()(const Settling&) const { return {"while it settles"}; }
    Course operator()(const Flight&) const { return {"in flight"}; }
    Course operator()(const Standing&) const { return {resting}; }

  private:
    // Whether the quantity is monotone in the angle of a rolling body.
    bool is_along() const { return quantity != Quantity::z && quantity != Quantity::omega; }

    template <class Steps>
    static Course of_steps(const Steps& steps) {
        Course found{rolling};
        for (const auto& knot : steps.knots) found.knots.push_back({knot.t, 0.0});
        return found;
    }
};

// Finds the turning points of an observable, segment by segment.
struct Survey {
    double unit;  // unit of the times of a course [s]
    const Observable& of;
    Observable theta;
    double quarters = 0.0;  // quarter turns searched so far

    // The stretch between the times `first` and `last` [s] of a segment that starts at `begin` [in
    // units of the motion].
    Stretch stretch(const Course& course, double begin, double first, double last) {
        Stretch stretch{course.where, {first, last}, {}};
        for (const DoubleDouble& knot : course.knots) {
            const double t = double(knot + begin) * unit;
            if (first < t && t < last) stretch.times.push_back(t);
        }
        sort_once(stretch.times);
        if (!course.monotone) add_turning_points(course, stretch);
        stretch.values = of.measure(stretch.times);
        return stretch;
    }

    void add_turning_points(const Course& course, Stretch& stretch) {
        constexpr double parts_a_period = 8;
        std::vector<double>& times = stretch.times;
        if (!course.period) {
            stretch.proved = divide(times, 1.0);
            return;
        }
        const double first = times.front();
        const double last = times.back();
        const double period = double(*course.period) * unit;
        const double periods = (last - first) / period;
        if (!of.quantity || periods < 5) {
            count(course.swung * periods);
            stretch.proved = divide(times, std::ceil(parts_a_period * periods));
            return;
        }
        stretch.period = *course.period * unit;
        times = {first, first + 2 * period};
        std::vector<double> ending{last - 2 * period, last};
        const bool begin_proved = divide(times, 2 * parts_a_period);
        stretch.proved = divide(ending, 2 * parts_a_period) && begin_proved;
        times.insert(times.end(), ending.begin(), ending.end());
    }

    // Adds the turning points between the times, where the motion is smooth. Each interval is
    // divided into `least` parts and four more for every quarter turn. For a caller's function,
    // which may change even at rest, `least` is at least 16/n, rounded up, where n is the number of
    // times. Returns whether the observable is proved to be monotone between the times.
    bool divide(std::vector<double>& times, double least) {
        constexpr double parts_a_quarter = 4;
        if (!of.quantity) least = std::max(least, std::ceil(16.0 / double(times.size())));
        const std::vector<double> ends = times;
        const std::vector<double> angles = theta.measure(ends);
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            const double turned = std::abs(angles[i + 1] - angles[i]) / half_pi;
            count(turned);
            const double parts = least + std::floor(parts_a_quarter * turned);
            for (double k = 1; k < parts; ++k) {
                times.push_back(ends[i] + (ends[i + 1] - ends[i]) * k / parts);
            }
        }
        sort_once(times);
        return add_turns(of.measure, of.length, times) && of.quantity;
    }

    void count(double more) {
        constexpr double most = 100'000;
        quarters += more;
        if (!(quarters > most)) return;
        refuse_length(of, "be searched over at most 100000 quarter turns",
                      "a motion of " + text(std::round(quarters)));
    }
};

}  // namespace

void refuse_length(const Observable& of, const std::string& requirement, const std::string& got) {
    throw std::invalid_argument((of.quantity ? name(*of.quantity) : "function") + " must " +
                                requirement + ", got " + got + ": simulate a shorter motion");
}

Observable observable(const Motion& motion, Quantity quantity, const Checkpoint& checkpoint) {
    constexpr std::size_t many = 1000;  // expected number of samples, enough for a table to pay off
    const auto sample = std::make_shared<const Sampler>(motion, many);
    const auto values = [&motion, &checkpoint, sample, quantity](const std::vector<double>& times) {
        constexpr std::size_t together = 1024;
        std::vector<double> values(times.size());
        for (std::size_t i = 0; i < times.size(); i += together) {
            checkpoint();
            measure(motion, *sample, quantity, times.data() + i,
                    std::min(together, times.size() - i), values.data() + i);
        }
        return values;
    };
    const bool is_path = quantity == Quantity::x || quantity == Quantity::contact_x;
    const double long_axis = std::max(motion.scene.a, motion.scene.b) * motion.units.length;
    return {quantity, values, is_path ? long_axis : 0.0};
}

std::vector<Stretch> stretches(const Motion& motion, double last, const Observable& of,
                               const Checkpoint& checkpoint) {
    const CourseOf course{of.quantity};
    Survey survey{motion.units.time, of, observable(motion, Quantity::theta, checkpoint)};
    std::vector<Stretch> all;
    for (auto segment = motion.segments.begin(); segment != motion.segments.end(); ++segment) {
        const double first = segment->begin * motion.units.time;
        if (first > last) break;
        const auto next = segment + 1;
        const double until =
            next == motion.segments.end() ? infinity : next->begin * motion.units.time;
        const double end = until > last ? last : std::nextafter(until, 0.0);
        if (end < first) continue;
        const auto of_law = [&](const auto& law) { return course(itself(law)); };
        all.push_back(survey.stretch(std::visit(of_law, segment->law), segment->begin, first, end));
    }
    return all;
}

}  // namespace rolling_ellipse
