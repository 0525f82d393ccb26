#include <algorithm>
#include <cmath>
#include <limits>

#include "bindings/bindings.hpp"
#include "bindings/samples.hpp"
#include "rolling/flow_table.hpp"
#include "simulate.hpp"

namespace rolling_ellipse::bindings {
namespace {

RollingStart validated_start(const Body& body, double theta, double omega) {
    validate(body);
    validate_motion(body, theta, omega);
    return rolling_start(body, theta, omega);
}

RollingMotion validated_motion(const Body& body, double theta, double omega) {
    return rolling_motion(validated_start(body, theta, omega));
}

py::tuple flow_scalar(double t, double a, double b, double theta, double omega, double gravity,
                      std::optional<double> gyration2) {
    const RollingMotion motion = validated_motion(body(a, b, gyration2, gravity), theta, omega);
    validate_time(t, longest_time(motion));
    const FlowSample now = sample(motion, t);
    return py::make_tuple(now.theta, now.omega, now.x);
}

// theta, omega, x of one motion at many times.
py::tuple flow_times(const Array& t, double a, double b, double theta, double omega, double gravity,
                     std::optional<double> gyration2, int workers) {
    const py::ssize_t n = t.size();
    require_length("t", t, n);
    const RollingFlow flow =
        rolling_flow(validated_start(body(a, b, gyration2, gravity), theta, omega));
    const FlowSampler sampler(flow, n);
    const double longest = longest_time(flow);
    const double most = std::min(longest, std::numeric_limits<double>::max());
    std::vector<Array> out = empty_arrays(3, n);
    const FlowColumns found = columns(out);
    const double* const times = t.data();
    run_interruptible(n, workers, [&](py::ssize_t begin, py::ssize_t end) {
        const py::ssize_t wrong =
            begin + flow_kernel().first_beyond(times + begin, end - begin, most);
        if (wrong < end) {
            validate_time(times[wrong], longest, "t[" + std::to_string(wrong) + "]");
        }
        sampler(times + begin, end - begin, found.from(begin));
    });
    return py::make_tuple(out[0], out[1], out[2]);
}

// t, a, b, theta, omega, gravity, gyration2, each with n elements, or one.
py::tuple flow_array(py::ssize_t n, const std::array<Array, 7>& arguments, int workers) {
    std::vector<Array> out = empty_arrays(3, n);
    double* const columns[] = {out[0].mutable_data(), out[1].mutable_data(), out[2].mutable_data()};
    const std::array<Argument, 7> of =
        arguments_of<7>({"t", "a", "b", "theta", "omega", "gravity", "gyration2"}, arguments, n);
    run_interruptible(n, workers, [&](py::ssize_t begin, py::ssize_t end) {
        std::array<double, 6> last{};
        RollingMotion motion{};
        for (py::ssize_t i = begin; i < end; ++i) {
            std::array<double, 6> now{};
            for (std::size_t p = 0; p < now.size(); ++p) now[p] = of[1 + p][i];
            if (i == begin || now != last) {
                motion = validated_motion({now[0], now[1], now[5], now[4]}, now[2], now[3]);
                last = now;
            }
            validate_time(of[0][i], longest_time(motion));
            const FlowSample at = sample(motion, of[0][i]);
            columns[0][i] = at.theta;
            columns[1][i] = at.omega;
            columns[2][i] = at.x;
        }
    });
    return py::make_tuple(out[0], out[1], out[2]);
}

}  // namespace

void bind_flow(py::module_& m) {
    m.def("period", py::overload_cast<const Scene&>(period), "scene"_a);
    m.def("flow_scalar", flow_scalar, "t"_a, "a"_a, "b"_a, "theta"_a, "omega"_a, "gravity"_a,
          "gyration2"_a);
    m.def("flow_times", flow_times, "t"_a, "a"_a, "b"_a, "theta"_a, "omega"_a, "gravity"_a,
          "gyration2"_a, "workers"_a);
    m.def("flow_array", flow_array, "n"_a, "arguments"_a, "workers"_a);
}

}  // namespace rolling_ellipse::bindings
