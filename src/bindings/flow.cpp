#include "rolling/slope/flow.hpp"

#include <algorithm>
#include <limits>

#include "bindings/bindings.hpp"
#include "bindings/shortened.hpp"
#include "rolling/level/kernel.hpp"
#include "simulate.hpp"

namespace rolling_ellipse::bindings {
namespace {

constexpr py::ssize_t scenes_at_once = 512;  // scenes per kernel call; their starts take 61 kB

RollingStart validated_start(const Body& body, double theta, double omega) {
    validate(body);
    validate_motion(body, theta, omega);
    return rolling_start(body, theta, omega);
}

// Returns theta, omega, x of one motion at many times.
py::tuple flow_times(const Array& t, double a, double b, double theta, double omega, double gravity,
                     std::optional<double> gyration2, int workers) {
    const py::ssize_t n = t.size();
    require_length("t", t, n);
    const RollingFlow flow =
        rolling_flow(validated_start(body(a, b, gyration2, gravity), theta, omega));
    const FlowSampler sampler(flow, n);
    const double longest = longest_time(flow);
    const double most = std::min(longest, std::numeric_limits<double>::max());
    FlowArrays out(n);
    const double* const times = t.data();
    run_interruptible(n, workers, [&](py::ssize_t begin, py::ssize_t end) {
        const py::ssize_t wrong = begin + kernel().first_beyond(times + begin, end - begin, most);
        if (wrong < end) {
            validate_time(times[wrong], longest, "t[" + std::to_string(wrong) + "]");
        }
        sampler(times + begin, end - begin, out.columns.from(begin));
    });
    return out.tuple();
}

const Kernel& kernel_called(const std::string& wanted) {
    if (wanted == "best") return kernel();
    std::string names;
    for (const Kernel& each : kernels()) {
        if (each.name == wanted) return each;
        names += ", '" + std::string(each.name) + "'";
    }
    throw std::invalid_argument("level must be one of 'best'" + names + ", got '" + wanted + "'");
}

// Takes t, a, b, theta, omega, gravity, gyration2, each with n elements or one.
py::tuple flow_array(py::ssize_t n, const std::array<Array, 7>& arguments, int workers,
                     const std::string& level) {
    const Arguments<7> of({"t", "a", "b", "theta", "omega", "gravity", "gyration2"}, arguments, n);
    // A single scene is computed without vector lanes, which would cost more.
    const Kernel& lanes = kernel_called(n == 1 && level == "best" ? "one by one" : level);
    FlowArrays out(n);
    const auto sample_all = [&](const Kernel& by, py::ssize_t begin, py::ssize_t end) {
        std::array<RollingStart, scenes_at_once> starts;
        std::array<double, scenes_at_once> times;
        std::array<FlowSample, scenes_at_once> samples;
        for (py::ssize_t i = begin; i < end; ++i) {
            const auto [t, a, b, theta, omega, gravity, gyration2] = of[i];
            starts[i - begin] = validated_start({a, b, gyration2, gravity}, theta, omega);
            times[i - begin] = t;
        }
        sample(by, starts.data(), times.data(), end - begin, samples.data());
        for (py::ssize_t i = begin; i < end; ++i) store(samples[i - begin], out.columns, i);
    };
    run_interruptible(n, workers, [&](py::ssize_t chunk_begin, py::ssize_t chunk_end) {
        for (py::ssize_t begin = chunk_begin; begin < chunk_end; begin += scenes_at_once) {
            const py::ssize_t end = std::min(begin + scenes_at_once, chunk_end);
            try {
                sample_all(lanes, begin, end);
            } catch (const std::invalid_argument&) {
                // Vector lanes validate the times last; the scenes are sampled again one by one, so
                // that the error names the first invalid scene.
                for (py::ssize_t i = begin; i < end; ++i) {
                    of.naming(i, [&] { sample_all(kernels().front(), i, i + 1); });
                }
            }
        }
    });
    return out.tuple();
}

using FlowArguments = std::array<double, 8>;  // t, a, b, theta, omega, gravity, gyration2, slope

// A motion on a slope, followed forward or backward in time. Backward, it is computed as a forward
// motion from the start with its velocity reversed.
struct SlopeMotion {
    double heading;
    SlopeFlow flow;
};

SlopeMotion slope_motion(const FlowArguments& of) {
    const auto [t, a, b, theta, omega, gravity, gyration2, slope] = of;
    const Body body{a, b, gyration2, gravity};
    validate(body);
    validate_motion(body, theta, omega);
    validate_slope(slope);
    const double heading = t < 0 ? -1.0 : 1.0;
    return {heading, slope_flow(body, slope, theta, heading * omega, 0.0)};
}

void prepare(SlopeMotion& motion, double t) {
    validate_time(t, std::numeric_limits<double>::max());
    prepare(motion.flow, std::abs(t));
    validate_time(t, longest_time(motion.flow, std::abs(t)));
}

bool is_same_motion(const FlowArguments& x, const FlowArguments& y) {
    return std::equal(x.begin() + 1, x.end(), y.begin() + 1) && (x[0] < 0) == (y[0] < 0);
}

FlowSample flow_sample(const FlowArguments& of) {
    const auto [t, a, b, theta, omega, gravity, gyration2, slope] = of;
    if (slope == 0) {
        return sample_alone(validated_start({a, b, gyration2, gravity}, theta, omega), t);
    }
    SlopeMotion motion = slope_motion(of);
    prepare(motion, t);
    FlowSample now = sample(motion.flow, std::abs(t));
    now.omega *= motion.heading;
    return now;
}

py::tuple flow_scalar(double t, double a, double b, double theta, double omega, double gravity,
                      std::optional<double> gyration2, double slope) {
    const double k2 = body(a, b, gyration2, gravity).gyration2;
    const FlowSample now = flow_sample({t, a, b, theta, omega, gravity, k2, slope});
    return py::make_tuple(now.theta, now.omega, now.x);
}

// The fast path of Python's `flow`, for plain floats within range and the default number of
// workers. Returns null if the arguments need the general path.
PyObject* flow_of_floats(PyObject* const* values, PyObject* const* defaults) {
    constexpr std::size_t gyration2 = 6, workers = 8;
    FlowArguments of;
    for (std::size_t k = 0; k < of.size(); ++k) {
        if (k == gyration2 && values[k] == Py_None) continue;
        if (!PyFloat_CheckExact(values[k])) return nullptr;
        of[k] = PyFloat_AS_DOUBLE(values[k]);
    }
    if (values[workers] != defaults[workers]) return nullptr;
    try {
        if (values[gyration2] == Py_None) of[gyration2] = uniform_disc_gyration2(of[1], of[2]);
        const FlowSample now = flow_sample(of);
        return py::make_tuple(now.theta, now.omega, now.x).release().ptr();
    } catch (const std::exception&) {
        return nullptr;
    }
}

// Takes t, a, b, theta, omega, gravity, gyration2, slope, each with n elements or one.
py::tuple slope_flow_array(py::ssize_t n, const std::array<Array, 8>& arguments, int workers) {
    const Arguments<8> of({"t", "a", "b", "theta", "omega", "gravity", "gyration2", "slope"},
                          arguments, n);
    FlowArrays out(n);
    run_interruptible(n, workers, [&](py::ssize_t begin, py::ssize_t end) {
        std::vector<double> times;
        std::vector<FlowSample> samples;
        for (py::ssize_t i = begin; i < end;) {
            const FlowArguments first = of[i];
            if (first.back() == 0) {
                of.naming(i, [&] { store(flow_sample(first), out.columns, i); });
                ++i;
                continue;
            }
            // Consecutive times of the same motion share one SlopeMotion.
            std::optional<SlopeMotion> motion;
            of.naming(i, [&] { motion = slope_motion(first); });
            times.clear();
            for (py::ssize_t next = i; next < end; ++next) {
                const FlowArguments here = of[next];
                if (!is_same_motion(here, first)) break;
                of.naming(next, [&] { prepare(*motion, here[0]); });
                times.push_back(std::abs(here[0]));
            }
            samples.resize(times.size());
            sample(motion->flow, times.data(), times.size(), samples.data());
            for (const FlowSample& each : samples) {
                store({each.theta, motion->heading * each.omega, each.x}, out.columns, i++);
            }
        }
    });
    return out.tuple();
}

}  // namespace

void bind_flow(py::module_& m) {
    m.def("period", py::overload_cast<const Scene&>(period), "scene"_a);
    m.def("flow_scalar", flow_scalar, "t"_a, "a"_a, "b"_a, "theta"_a, "omega"_a, "gravity"_a,
          "gyration2"_a, "slope"_a);
    m.def(
        "takes_floats", [](const py::function& flow) { return shortened(flow, flow_of_floats); },
        "flow"_a);
    m.def("flow_times", flow_times, "t"_a, "a"_a, "b"_a, "theta"_a, "omega"_a, "gravity"_a,
          "gyration2"_a, "workers"_a);
    m.def("flow_array", flow_array, "n"_a, "arguments"_a, "workers"_a, "level"_a = "best");
    m.def("slope_flow_array", slope_flow_array, "n"_a, "arguments"_a, "workers"_a);
    m.def("flow_levels", [] { return py::list(names_of(kernels())); });
}

}  // namespace rolling_ellipse::bindings
