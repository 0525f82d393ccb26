// Five standard jobs, chosen by number; tools/hot_loops.py counts their instructions.

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "motions.hpp"
#include "rolling/level/kernel.hpp"
#include "simulate.hpp"

using namespace rolling_ellipse;

namespace {

void require(bool holds) {
    if (!holds) throw std::logic_error("the job is not what its name says");
}

void one_state() {
    const RollingStart start = rolling_start(ellipse(0.1, 3.2).body(), 0.1, 3.2);
    require(sample(rolling_flow(start), 5.0).theta > 0.1);
}

void thousand_samples() {
    const RollingStart start = rolling_start(ellipse(0.1, 3.2).body(), 0.1, 3.2);
    const RollingFlow flow = rolling_flow(start);
    std::vector<double> times;
    for (int i = 0; i < 1000; ++i) times.push_back(0.01 * i);
    std::vector<FlowSample> samples(times.size());
    FlowSampler(flow, times.size())(times.data(), times.size(), samples.data());
    require(samples.back().theta > 0.1);
}

void ten_events() {
    Scene scene = ellipse(0.5, 0.0, 0.3);
    scene.restitution = 0.6;
    scene.z = 3.0;
    Settings settings = settings_of(Model::contact, Method::automatic);
    settings.max_events = 10;
    require(simulate(scene, settings, 1e3, [] {}).motion.events.size() == 10);
}

void ten_half_turns() {
    const Scene scene = ellipse(0.0, 3.2);
    const double t = 5 * period(scene);
    const Settings settings = settings_of(Model::rolling, Method::dop853);
    require(simulate(scene, settings, t, [] {}).followed_until == t);
}

void hundred_steps() {
    const Settings settings = settings_of(Model::multipliers, Method::rk4, 0.01);
    require(simulate(ellipse(0.1, 3.2), settings, 1.0, [] {}).counts.steps == 100);
}

constexpr void (*jobs[])() = {one_state, thousand_samples, ten_events, ten_half_turns,
                              hundred_steps};

}  // namespace

// callgrind counts the instructions of the function of this name.
[[gnu::noinline]] void counted(void (*job)()) {
    job();
    asm volatile("");  // prevents a tail call, whose end callgrind would not see
}

int main(int count, char** words) {
    const int which = count == 2 ? std::atoi(words[1]) : -1;
    if (which < 0 || which >= static_cast<int>(std::size(jobs))) return 2;
    jobs[which]();  // makes the static tables
    counted(jobs[which]);
    std::puts(kernel().name);
    return 0;
}
