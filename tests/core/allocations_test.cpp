// Single steps and samples allocate no memory, apart from the growth of the vectors that store the
// steps. The test counts allocations for a number of steps or samples and for twice as many.
//
//     cmake --preset release && cmake --build --preset release && ctest --preset release

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <vector>

#include "motions.hpp"
#include "outcome/outcome.hpp"
#include "rolling/level/kernel.hpp"
#include "simulate.hpp"

namespace {

std::atomic<long> asked{0};

void* memory(std::size_t size) {
    ++asked;
    if (void* const found = std::malloc(size == 0 ? 1 : size)) return found;
    throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return memory(size); }
void* operator new[](std::size_t size) { return memory(size); }
void operator delete(void* at) noexcept { std::free(at); }
void operator delete[](void* at) noexcept { std::free(at); }
void operator delete(void* at, std::size_t) noexcept { std::free(at); }
void operator delete[](void* at, std::size_t) noexcept { std::free(at); }

using namespace rolling_ellipse;

namespace {

int failures = 0;

template <class Action>
long allocations(const Action& action) {
    const long before = asked;
    action();
    return asked - before;
}

void check(bool holds, const char* what, long once, long twice) {
    if (holds) return;
    std::printf("%s: %ld allocations, %ld for twice as much\n", what, once, twice);
    ++failures;
}

Scene scene_of(double omega) { return ellipse(0.1, omega, 0.9); }

struct Job {
    const char* name;
    Scene scene;
    Settings settings;
    double t;
};

const Job stepped[] = {
    {"dop853", scene_of(1.0), settings_of(Model::rolling, Method::dop853), 20.0},
    {"dopri5", scene_of(1.0), settings_of(Model::rolling, Method::dopri5), 10.0},
    {"rk4", scene_of(1.0), settings_of(Model::rolling, Method::rk4, 0.01), 1.0},
    {"gauss", scene_of(1.0), settings_of(Model::rolling, Method::gauss, 0.01), 1.0},
    {"radau", scene_of(1.0), settings_of(Model::rolling, Method::radau, 0.01), 1.0},
    {"dop853 on a slope", on_slope(scene_of(3.0), 0.1), settings_of(Model::rolling, Method::dop853),
     10.0},
    {"multipliers", scene_of(1.0), settings_of(Model::multipliers, Method::dop853), 20.0},
    {"Baumgarte", scene_of(1.0),
     settings_of(Model::multipliers, Method::dopri5, {}, Stabilization::baumgarte), 10.0},
    {"projection and energy", scene_of(1.0),
     settings_of(Model::multipliers, Method::rk4, 0.01, Stabilization::projection_energy), 1.0},
    {"Gear, Gupta and Leimkuhler", scene_of(1.0),
     settings_of(Model::multipliers, Method::radau, 0.01, Stabilization::ggl), 1.0},
};

const Job sampled[] = {
    {"exact", scene_of(1.0), settings_of(Model::rolling, Method::exact), 20.0},
    {"exact on a slope", on_slope(scene_of(3.0), 0.1),
     settings_of(Model::automatic, Method::automatic), 9.0},
    {"a jump", scene_of(5.5), settings_of(Model::contact, Method::automatic), 0.8},
    {"a slide", skidding(0.1, 0.0, 3.0, 0.1), settings_of(Model::contact, Method::automatic), 1.0},
};

// The knots and the dense output are stored in two vectors, which double their capacity when full.
// Twice as many steps therefore cause at most one more allocation in each vector.
void steps_allocate_nothing() {
    constexpr long vectors = 2;
    for (const Job& job : stepped) {
        long steps[2];
        long found[2];
        for (const int times : {1, 2}) {
            found[times - 1] = allocations([&] {
                const Solution solution = simulate(job.scene, job.settings, times * job.t, [] {});
                steps[times - 1] = solution.counts.steps;
            });
        }
        // One allocation per step would make a difference of at least 50.
        check(steps[1] - steps[0] >= 50 && found[1] - found[0] <= vectors, job.name, found[0],
              found[1]);
    }
}

// Takes samples, then twice as many samples of the same segments. Each segment may allocate once
// per call.
template <class Sample>
void kind_of_sample(const Job& job, const Solution& solution) {
    const Sampler sampler(solution.motion, 1000);
    const auto take = [&](std::size_t n) {
        std::vector<double> times;
        for (std::size_t i = 0; i < n; ++i) times.push_back(job.t * i / n);
        std::vector<Sample> samples(n);
        return allocations([&] { sampler(times.data(), n, samples.data()); });
    };
    const long once = take(100);
    const long twice = take(200);
    check(once == twice, job.name, once, twice);
}

void samples_allocate_nothing() {
    const auto all_kinds = [](const Job& job) {
        const Solution solution = simulate(job.scene, job.settings, job.t, [] {});
        kind_of_sample<FlowSample>(job, solution);
        kind_of_sample<ContactSample>(job, solution);
        kind_of_sample<CoordinateState>(job, solution);
    };
    for (const Job& job : sampled) all_kinds(job);
    for (const Job& job : stepped) all_kinds(job);
}

void bodies_allocate_nothing() {
    constexpr std::size_t n = 512;
    std::vector<RollingStart> starts;
    std::vector<double> times;
    for (std::size_t i = 0; i < 2 * n; ++i) {
        starts.push_back(rolling_start(scene_of(0.0).body(), 0.1, 0.5 + 0.003 * i));
        times.push_back(2.0);
    }
    std::vector<FlowSample> samples(times.size());
    for (const Kernel& kernel : kernels()) {
        const auto take = [&](std::size_t count) {
            return allocations(
                [&] { sample(kernel, starts.data(), times.data(), count, samples.data()); });
        };
        const long once = take(n);
        const long both = take(2 * n);
        check(once == both, kernel.name, once, both);
    }
    for (std::size_t i = 0; i < 2 * n; ++i) {
        const long one =
            allocations([&] { samples[i] = sample(rolling_flow(starts[i]), times[i]); });
        const long judged = allocations([&] { classify(starts[i].body, 0.6, 0.1, 1.0); });
        check(one == 0, "one state", 0, one);
        check(judged == 0, "one outcome", 0, judged);
    }
}

void it_counts() {
    const long once = allocations([] { std::vector<double> one(3); });
    check(once == 1, "a vector", once, 1);
}

}  // namespace

int main() {
    it_counts();
    steps_allocate_nothing();
    samples_allocate_nothing();
    bodies_allocate_nothing();
    return verdict(failures);
}
