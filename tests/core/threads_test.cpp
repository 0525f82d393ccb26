// Several threads that run the core at the same time give the same bits as one thread. Tests from
// Python show less, since Python's global lock serialises much of the package. ThreadSanitizer
// (preset tsan) shows that the threads share no mutable state.
//
//     cmake --preset tsan && cmake --build --preset tsan && ctest --preset tsan

#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <thread>
#include <vector>

#include "motions.hpp"
#include "outcome/outcome.hpp"
#include "rolling/level/kernel.hpp"
#include "simulate.hpp"

using namespace rolling_ellipse;

namespace {

constexpr int threads = 8;
// Number of jobs that each thread runs, every fifth one of the list. Together, the 8 threads run
// every job, and most jobs at least twice.
constexpr int rounds = 8;

using Numbers = std::vector<double>;
using Work = std::function<Numbers()>;

Scene scene_of(double omega) { return bouncing(0.1, omega, 0.6); }

Settings loose(Model model, Method method, std::optional<double> step = {}) {
    Settings settings = settings_of(model, method, step);
    settings.rtol = 1e-8;
    settings.atol = 1e-10;
    return settings;
}

Numbers samples(const Solution& solution) {
    Numbers times;
    for (int i = 0; i < 150; ++i) times.push_back(solution.followed_until * i / 150);
    std::vector<ContactSample> found(times.size());
    Sampler(solution.motion, times.size())(times.data(), times.size(), found.data());
    Numbers numbers;
    for (const auto& [state, force] : found) {
        for (const double number :
             {state.theta, state.omega, state.x, state.z, force.normal, force.friction}) {
            numbers.push_back(number);
        }
    }
    return numbers;
}

Numbers solved(const Scene& scene, const Settings& settings) {
    return samples(simulate(scene, settings, 2.0, [] {}));
}

Numbers table() {
    const RollingFlow flow = rolling_flow(rolling_start(scene_of(3.0).body(), 0.1, 3.0));
    Numbers times, found(3 * 2000);
    for (int i = 0; i < 2000; ++i) times.push_back(0.01 * i);
    FlowSampler(flow, times.size())(times.data(), times.size(),
                                    {&found[0], &found[2000], &found[4000]});
    return found;
}

Numbers bodies() {
    std::vector<RollingStart> starts;
    Numbers times;
    for (int i = 0; i < 100; ++i) {
        starts.push_back(rolling_start(scene_of(1.0).body(), 0.1, 0.5 + 0.03 * i));
        times.push_back(2.0);
    }
    std::vector<FlowSample> found(times.size());
    sample(kernel(), starts.data(), times.data(), times.size(), found.data());
    Numbers numbers;
    for (const FlowSample& each : found) numbers.push_back(each.theta + each.omega + each.x);
    return numbers;
}

Numbers judgements(double omega) {
    const Body body = scene_of(omega).body();
    const Certificate level = certify(scene_of(omega));
    const Certificate slope = certify(on_slope(scene_of(omega), 0.1));
    const LiftOff lift = lift_off({2.0, 1.0, 0.0435, 9.81}, 0.2, 1.0, 0.25, [] {});
    return {level.smallest_normal_force.value_or(-1),
            slope.smallest_normal_force.value_or(-1),
            static_cast<double>(classify(body, 0.6, 0.1, omega)),
            static_cast<double>(outcome(on_slope(scene_of(omega), 0.1), [] {})),
            thresholds(body, 0.6).slip_speed(),
            lift.speed,
            period(scene_of(omega))};
}

// All jobs; one of them samples a motion that the threads share.
std::vector<Work> works() {
    static const Solution shared =
        simulate(scene_of(6.0), loose(Model::contact, Method::automatic), 2.0, [] {});
    std::vector<Work> all{table, bodies, [] { return samples(shared); }};
    for (const double omega : {1.0, 3.0, 5.5}) {
        all.push_back([=] { return judgements(omega); });
        for (const Settings& settings :
             {loose(Model::automatic, Method::automatic), loose(Model::contact, Method::automatic),
              loose(Model::rolling, Method::dop853), loose(Model::rolling, Method::dopri5),
              loose(Model::rolling, Method::rk4, 0.01), loose(Model::rolling, Method::gauss, 0.02),
              loose(Model::rolling, Method::radau, 0.02),
              loose(Model::multipliers, Method::dop853)}) {
            all.push_back([=] { return solved(scene_of(omega), settings); });
        }
        all.push_back([=] {
            return solved(on_slope(scene_of(omega), 0.1),
                          loose(Model::automatic, Method::automatic));
        });
        Settings ggl = loose(Model::multipliers, Method::radau, 0.02);
        ggl.stabilization = Stabilization::ggl;
        all.push_back([=] { return solved(scene_of(omega), ggl); });
    }
    return all;
}

}  // namespace

int main() {
    const std::vector<Work> all = works();
    std::vector<Numbers> together(threads * rounds);
    std::atomic<int> ready{0};
    const auto run = [&](int thread) {
        ++ready;
        while (ready < threads) std::this_thread::yield();
        for (int round = 0; round < rounds; ++round) {
            const int place = thread * rounds + round;
            together[place] = all[(thread + 5 * round) % all.size()]();
        }
    };
    std::vector<std::thread> started;
    for (int thread = 0; thread < threads; ++thread) started.emplace_back(run, thread);
    for (std::thread& thread : started) thread.join();
    int failures = 0;
    std::vector<Numbers> alone(all.size());
    for (int place = 0; place < threads * rounds; ++place) {
        const std::size_t which = (place / rounds + 5 * (place % rounds)) % all.size();
        if (alone[which].empty()) alone[which] = all[which]();
        if (!alone[which].empty() && same_bits(together[place], alone[which])) continue;
        std::printf("work %zu has other bits\n", which);
        ++failures;
    }
    return verdict(failures);
}
