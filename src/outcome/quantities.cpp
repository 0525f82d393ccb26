#include "outcome/quantities.hpp"

#include <algorithm>
#include <stdexcept>

namespace rolling_ellipse {
namespace {

constexpr std::size_t many = 1000;  // times, which a table of the motion is worth

}  // namespace

void refuse_length(std::optional<Quantity> quantity, const std::string& requirement,
                   const std::string& got) {
    constexpr const char* names[] = {"theta", "x", "z", "omega", "contact_x"};
    const std::string name = quantity ? names[static_cast<int>(*quantity)] : "function";
    throw std::invalid_argument(name + " must " + requirement + ", got " + got +
                                ": simulate a shorter motion");
}

Gauge::Gauge(const Motion& motion, const Checkpoint& checkpoint)
    : motion_(motion),
      checkpoint_(checkpoint),
      sample_(motion, many),
      axes_{motion.scene.a * motion.units.length, motion.scene.b * motion.units.length},
      has_coordinates_(std::holds_alternative<SteppedMultipliers>(motion.segments.front().law)) {}

std::vector<double> Gauge::operator()(Quantity quantity, const std::vector<double>& times) const {
    constexpr std::size_t together = 1024;
    std::vector<double> values(times.size());
    for (std::size_t i = 0; i < times.size(); i += together) {
        checkpoint_();
        measure(quantity, times.data() + i, std::min(together, times.size() - i),
                values.data() + i);
    }
    return values;
}

void Gauge::measure(Quantity quantity, const double* times, std::size_t n, double* values) const {
    const auto take = [&](auto sample, const auto& value) {
        std::vector<decltype(sample)> samples(n);
        sample_(times, n, samples.data());
        std::transform(samples.begin(), samples.end(), values, value);
    };
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
                return x + geometry(axes_, theta).dh;
        }
    };
    if (has_coordinates_) {
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

double Gauge::rounded_length(std::optional<Quantity> quantity) const {
    const bool has_path = quantity == Quantity::x || quantity == Quantity::contact_x;
    return has_path ? std::max(axes_.a, axes_.b) : 0.0;
}

}  // namespace rolling_ellipse
