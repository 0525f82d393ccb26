#include "outcome/stretches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "scene/refuse.hpp"

namespace rolling_ellipse {
namespace {

// The quantity at ascending times, by the kind of sample that has it at the least cost.
void measure(const Motion& motion, const Sampler& sample, Quantity quantity, const double* times,
             std::size_t n, double* values) {
    const auto take = [&](auto kind, const auto& value) {
        std::vector<decltype(kind)> samples(n);
        sample(times, n, samples.data());
        std::transform(samples.begin(), samples.end(), values, value);
    };
    const Axes axes{motion.scene.a * motion.units.length, motion.scene.b * motion.units.length};
    const auto of_state = [&](double theta, double omega, double x, double z) {
        switch (quantity) {
            case Quantity::theta:
                return theta;
            case Quantity::x:
                return x;
            case Quantity::z:
                return z;
            case Quantity::omega:
                return omega;
            default:
                return x + geometry(axes, theta).dh;
        }
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

// The stretch of one segment: each law as an overload.
class Survey {
  public:
    Survey(double begin, double unit, const Asked& of, const Asked& theta, double& quarters,
           Stretch& found)
        : begin_(begin),
          unit_(unit),
          first_(found.times.front()),
          last_(found.times.back()),
          of_(of),
          theta_(theta),
          quarters_(quarters),
          found_(found),
          times_(found.times) {}

    void operator()(const RollingFlow& flow) {
        const bool turns = flow.kind == MotionKind::rotation;
        const bool moves = turns || flow.kind == MotionKind::libration;
        if (of_.quantity && (!moves || (turns && along()))) return;
        const DoubleDouble half = flow.phase.half_turn;
        if (moves && !std::isinf(half.high)) return follow_periods(turns ? half : half * 2.0);
        follow(flow.kind == MotionKind::rest ? resting : rolling);
    }

    void operator()(const SlopeFlow& flow) {
        unit_ *= flow.body.time;
        begin_ /= flow.body.time;
        if (flow.kind == MotionKind::libration) {
            return follow_periods((flow.turnings[1] - flow.turnings[0]) * 2.0);
        }
        const bool runs = flow.kind == MotionKind::rotation;
        if (runs) add(flow.turnings);
        if (flow.acceleration != 0) add({{-flow.start.omega / flow.acceleration, 0.0}});
        if (of_.quantity && (!runs || along())) return;
        follow(flow.kind == MotionKind::rest ? resting : rolling);
    }

    void operator()(const SteppedRolling& motion) { follow(motion.steps); }
    void operator()(const SteppedMultipliers& motion) {
        std::visit([this](const auto& steps) { follow(steps); }, motion.steps);
    }

    void operator()(const Slide& slide) {
        std::vector<DoubleDouble> begins;
        for (const SlidePiece& piece : slide.pieces) begins.push_back(piece.centre.time);
        add(begins);
        follow("while it slides");
    }

    void operator()(const Settling&) { follow("while it settles"); }
    void operator()(const Flight&) { follow("in flight"); }
    void operator()(const Standing&) { follow(resting); }

  private:
    static constexpr const char* rolling = "while it rolls";
    static constexpr const char* resting = "while it rests";

    // Whether it grows with the angle of a body that rolls.
    bool along() const {
        return of_.quantity && of_.quantity != Quantity::z && of_.quantity != Quantity::omega;
    }

    // The time after so long since the begin of the segment, in units of the law.
    double time(const DoubleDouble& since) const { return double(since + begin_) * unit_; }

    // Adds those times after the begin of the segment that lie inside.
    void add(const std::vector<DoubleDouble>& since) {
        for (const DoubleDouble& each : since) {
            const double t = time(each);
            if (first_ < t && t < last_) times_.push_back(t);
        }
        sort_once(times_);
    }

    void count(double quarters) {
        constexpr double most = 100'000;
        quarters_ += quarters;
        if (!(quarters_ > most)) return;
        refuse_length(of_, "not be looked at over more than 100000 quarter turns",
                      "a motion of " + text(std::round(quarters_)));
    }

    template <class Steps>
    void follow(const Steps& steps) {
        std::vector<DoubleDouble> knots;
        for (const auto& knot : steps.knots) knots.push_back({knot.t, 0.0});
        add(knots);
        follow(rolling);
    }

    // Adds the turning points of what is smooth between the times, in so many parts from each to
    // the next at least, and in some a quarter turn; a function may change with the time alone.
    void follow(const char* where, double least = 1.0) {
        constexpr double parts_a_quarter = 4;
        if (!of_.quantity) least = std::max(least, std::ceil(16.0 / double(times_.size())));
        found_.where = where;
        const std::vector<double> ends = times_;
        const std::vector<double> theta = theta_.measure(ends);
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            const double turned = std::abs(theta[i + 1] - theta[i]) / half_pi;
            count(turned);
            const double parts = least + std::floor(parts_a_quarter * turned);
            for (double k = 1; k < parts; ++k) {
                times_.push_back(ends[i] + (ends[i + 1] - ends[i]) * k / parts);
            }
        }
        sort_once(times_);
        found_.monotone = add_turns(of_.measure, of_.length, times_) && of_.quantity;
    }

    // What comes again in each period, in units of the law: the first two and the last two of many.
    void follow_periods(const DoubleDouble& period) {
        constexpr double parts_a_period = 8;
        const double length = double(period) * unit_;
        const double periods = (last_ - first_) / length;
        if (!of_.quantity || periods < 5) {
            count(4 * periods);
            return follow(rolling, std::ceil(parts_a_period * periods));
        }
        found_.period = period * unit_;
        std::vector<double> last{last_ - 2 * length, last_};
        times_.back() = first_ + 2 * length;
        follow(rolling, 2 * parts_a_period);
        const bool monotone = found_.monotone;
        times_.swap(last);
        follow(rolling, 2 * parts_a_period);
        found_.monotone = found_.monotone && monotone;
        times_.insert(times_.begin(), last.begin(), last.end());
    }

    double begin_;
    double unit_;
    double first_;
    double last_;
    const Asked& of_;
    const Asked& theta_;
    double& quarters_;  // turns that were followed so far
    Stretch& found_;
    std::vector<double>& times_;
};

}  // namespace

void refuse_length(const Asked& of, const std::string& requirement, const std::string& got) {
    constexpr const char* names[] = {"theta", "x", "z", "omega", "contact_x"};
    const std::string name = of.quantity ? names[static_cast<int>(*of.quantity)] : "function";
    throw std::invalid_argument(name + " must " + requirement + ", got " + got +
                                ": simulate a shorter motion");
}

Asked asked(const Motion& motion, Quantity quantity, const Checkpoint& checkpoint) {
    constexpr std::size_t many = 1000;  // times, which a table of the motion is worth
    const auto sample = std::make_shared<const Sampler>(motion, many);
    const auto values = [&motion, &checkpoint, sample, quantity](const std::vector<double>& times) {
        constexpr std::size_t together = 1024;
        std::vector<double> found(times.size());
        for (std::size_t i = 0; i < times.size(); i += together) {
            checkpoint();
            measure(motion, *sample, quantity, times.data() + i,
                    std::min(together, times.size() - i), found.data() + i);
        }
        return found;
    };
    const bool is_path = quantity == Quantity::x || quantity == Quantity::contact_x;
    const double long_axis = std::max(motion.scene.a, motion.scene.b) * motion.units.length;
    return {quantity, values, is_path ? long_axis : 0.0};
}

std::vector<Stretch> stretches(const Motion& motion, double last, const Asked& of,
                               const Checkpoint& checkpoint) {
    const Asked theta = asked(motion, Quantity::theta, checkpoint);
    const double unit = motion.units.time;
    double quarters = 0.0;
    std::vector<Stretch> found;
    for (auto segment = motion.segments.begin(); segment != motion.segments.end(); ++segment) {
        const double begin = segment->begin * unit;
        if (begin > last) break;
        const auto next = segment + 1;
        const bool ends_here = next == motion.segments.end() || next->begin * unit > last;
        const double end = ends_here ? last : std::nextafter(next->begin * unit, 0.0);
        if (end < begin) continue;
        Stretch here{"while it rolls", {begin, end}};
        Survey survey(segment->begin, unit, of, theta, quarters, here);
        std::visit([&](const auto& law) { survey(itself(law)); }, segment->law);
        found.push_back(std::move(here));
    }
    return found;
}

}  // namespace rolling_ellipse
