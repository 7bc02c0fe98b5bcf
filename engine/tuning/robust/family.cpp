#include "engine/tuning/robust/family.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/loop/worst_case.h"
#include "engine/tuning/robust/feasibility.h"

namespace tunewright::robust {
namespace {

Error both_signs() {
    return {ErrorKind::no_feasible_controller, "",
            "Some of the plants need a positive and some a negative gain, so no controller stabilises all of them. "
            "Narrow the uncertainty. For a recorded test, even the sign of the plant's gain is uncertain: repeat the "
            "test with a larger step."};
}

}  // namespace

Expected<std::vector<LinearPlant>> other_members(const TuningProblem& tuning, double (*sign_of)(const LinearPlant&)) {
    std::vector<LinearPlant> members;
    if (!tuning.family) return members;
    for (const auto& member : members_without_nominal(*tuning.family)) {
        auto linear = LinearPlant::make(member);
        if (!linear) return linear.error();
        if (sign_of(*linear) != sign_of(tuning.linear)) return both_signs();
        members.push_back(std::move(*linear));
    }
    return members;
}

double excess_on(const LinearPlant& plant, const DesignProblem& problem, const DesignPoint& x,
                 const GridFineness& fineness) {
    const auto loop = Loop::make(plant, to_parallel(controller_at(problem, x)));
    if (!is_stable(loop)) return std::numeric_limits<double>::infinity();
    return excess_of(find_peaks(*loop, make_loop_grid(*loop, fineness.step, fineness.density)), problem.limits);
}

double worst_excess(const DesignProblem& problem, const DesignPoint& x) {
    double worst = -1;
    if (problem.measured != nullptr) {
        const auto peaks = stable_peaks(MeasuredLoop::make(*problem.measured, to_parallel(controller_at(problem, x))));
        return peaks ? excess_of(*peaks, problem.limits) : std::numeric_limits<double>::infinity();
    }
    for (std::size_t i = 0; i < problem.plants(); ++i)
        worst = std::max(worst, excess_on(problem.plant_at(i), problem, x, {.step = 0.06, .density = 53}));
    return worst;
}

std::vector<LinearPlant> worst_inside(const PlantFamily& family, const DesignProblem& problem, const DesignPoint& x,
                                      const std::stop_token& stop) {
    const PlantCost cost = [&](const LinearPlant& plant) { return excess_on(plant, problem, x, {}); };
    std::vector<LinearPlant> found;
    for (const auto& region : family.regions) {
        if (region.dimension() == 0) continue;
        for (const auto& starts : {region.spread(kRegionSamples), region.ends()}) {
            const WorstCase worst = find_worst_case(region, cost, starts, stop);
            if (!(worst.cost > limits::kMaxRelativeExcessJudged)) continue;
            if (auto plant = LinearPlant::make(region.at(worst.z))) found.push_back(std::move(*plant));
        }
    }
    return found;
}

}  // namespace tunewright::robust
