#include "engine/simulation/linear/run_setup.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/simulation/run/loop_sizes.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr int kMinLevelOfL = 3, kMaxLevelOfL = 30;  // steps in a dead time, as a power of 2
constexpr double kMaxStepOverGrowthTime = 0.25;     // of an unstable mode's time constant: longest step
constexpr double kMaxMapped = 1000;                 // multiple of the plant's own time: longest step with a map

constexpr double kMaxStepOverFastestTime =
    0.25;  // of the fastest mode's time constant: a cubic through a step's ends is accurate for it
constexpr double kMaxStepOverDeadTime = 0.125;  // a power of 2, because the lengths of steps double

double longest_step(const LinearPlant& plant) {
    double longest = std::numeric_limits<double>::infinity();
    for (const auto pole : plant.poles())
        if (pole.real() > 0) longest = std::min(longest, kMaxStepOverGrowthTime / pole.real());
    return longest;
}

void choose_h0(RunSetup& setup, const LinearPlant& plant, const ParallelPid& controller) {
    const ResponseSystem& system = setup.system;
    double fastest = fastest_rate(system, plant, controller);
    if (!system.delayed) {
        // The rates of the single states count as well as those of the loop.
        for (int i = 0; i < system.s.n; ++i)
            fastest = std::max(fastest, std::abs(system.s.F[Index(i * system.s.n + i)]));
        setup.h0 = first_step(system, std::max(fastest, std::numeric_limits<double>::min()));
        return;
    }
    const double doublings = std::log2(system.s.L / first_step(system, fastest));
    setup.level_of_L = std::clamp(static_cast<int>(std::ceil(doublings)), kMinLevelOfL, kMaxLevelOfL);
    setup.h0 = std::ldexp(system.s.L, -setup.level_of_L);
}

}  // namespace

RunSetup set_up_run(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in,
                    const StepSchedule* repeat) {
    RunSetup setup{.system = make_response_system(plant, controller, in),
                   .steady = steady_outputs(plant, controller, in),
                   .longest = longest_step(plant)};
    if (repeat == nullptr) {
        choose_h0(setup, plant, controller);
    } else {
        setup.h0 = repeat->h0;
        if (setup.system.delayed)
            setup.level_of_L = static_cast<int>(std::lround(std::log2(setup.system.s.L / setup.h0)));
    }
    setup.last_mapped = static_cast<int>(std::log2(kMaxMapped * own_time(plant, controller) / setup.h0));
    return setup;
}

double fastest_rate(const ResponseSystem& system, const LinearPlant& plant, const ParallelPid& controller) {
    double fastest = 0;
    for (const auto pole : plant.poles()) fastest = std::max(fastest, std::abs(pole));
    if (controller.setpoint_lag > 0) fastest = std::max(fastest, 1 / controller.setpoint_lag);
    if (controller.filter.type != FilterType::none) fastest = std::max(fastest, 1 / controller.filter.Tf);
    if (!system.delayed)
        for (const auto pole : eigenvalues(system.s.F, system.s.n)) fastest = std::max(fastest, std::abs(pole));
    return fastest;
}

double first_step(const ResponseSystem& system, double fastest) {
    const double by_rate = fastest > 0 ? kMaxStepOverFastestTime / fastest : std::numeric_limits<double>::infinity();
    return system.delayed ? std::min(kMaxStepOverDeadTime * system.s.L, by_rate) : by_rate;
}

double own_time(const LinearPlant& plant) {
    const double time = plant.time_scale();
    return time > 0 ? time : 1;
}

}  // namespace tunewright
