#include "engine/range/run/scheduled_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/plant/linear/linear_plant.h"
#include "engine/range/run/profile.h"
#include "engine/simulation/nonlinear/linearising_response.h"

namespace tunewright::range {
namespace {

constexpr double kSettledStepShare = 0.01;  // of the step

Error none(std::string why) { return {ErrorKind::unsupported, "", std::move(why)}; }

Expected<double> slowest_loop(const SteadyBranch& branch, const Schedule& schedule) {
    double slowest = 0;
    for (const ScheduleRow& row : schedule.rows) {
        const auto state = branch.at(std::clamp(row.at, branch.low(), branch.high()));
        if (!state) return state.error();
        const auto plant = LinearPlant::make(branch.linearised(*state));
        if (!plant) return plant.error();
        const double gain = plant->integrators() > 0 ? 1 / std::abs(row.Kp) : plant->low_frequency_gain();
        slowest = std::max(slowest, row.Ti / std::abs(gain * row.Kp));
    }
    return slowest;
}

ScheduledRun run_of(LinearisingResponse response, const NonlinearSystem& system, double target, double horizon,
                    int samples) {
    ScheduledRun run;
    run.limited = response.limited;
    run.ended = std::move(response.ended);
    const double step = horizon / (samples - 1);
    double before = 0;
    for (std::size_t k = 0; k < response.even.y.size(); ++k) {
        const double y = system.y_steady() + response.even.y[k], error = std::abs(target - y);
        run.t.push_back(step * double(k));
        run.target.push_back(target);
        run.y.push_back(y);
        run.u.push_back(system.u_nominal() + response.even.u[k]);
        run.at.push_back(y);
        run.largest_error = std::max(run.largest_error, error);
        if (k > 0) run.IAE += 0.5 * step * (before + error);
        before = error;
    }
    run.settled = run.ended.empty() && before <= kSettledStepShare * std::abs(target - system.y_steady());
    return run;
}

}  // namespace

Expected<LinearisingPassage> run_linearising(const SteadyBranch& branch, const Schedule& schedule,
                                             const Profile& profile, const RunOptions& options) {
    if (branch.range().along == Along::parameter)
        return none("A parameter moves, which the nonlinear controller knows.");
    if (profile.size() != 2 || profile[0].t != 0 || profile[1].t != 0)
        return none("It is run through single steps of the set point.");
    const auto start = rest_at(branch, profile.front().value);
    if (!start) return start.error();
    const auto system = NonlinearSystem::make(branch.plant_at(*start));
    if (!system) return system.error();
    const auto degree = relative_degree(*system);
    if (!degree) return none(degree.error().message);
    if (!zero_dynamics(*system).stable)
        return none(
            "The plant's zero dynamics are unstable at the start: a controller that linearises it lets its "
            "states grow without bound.");
    const auto tau = slowest_loop(branch, schedule);
    if (!tau) return tau.error();
    const TargetResponse target =
        target_of_poles(std::vector<std::complex<double>>(std::size_t(*degree), -*degree / *tau));
    const RunControl control{.stop = options.stop, .progress = {}, .now_ms = {}};
    LinearisingResponse response =
        simulate_linearising(*system, target, profile.back().value - profile.front().value,
                             {.horizon = options.horizon, .samples = options.samples}, control);
    return LinearisingPassage{
        run_of(std::move(response), *system, profile.back().value, options.horizon, options.samples), *tau};
}

}  // namespace tunewright::range
