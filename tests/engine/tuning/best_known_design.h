// The best known robust design for a problem, from searches that share only the problem's terms with `fast`: those of
// the paper, and quadratic programming from random feasible points.
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"
#include "engine/tuning/robust/cost.h"
#include "engine/tuning/robust/family.h"
#include "engine/tuning/robust/sqp.h"
#include "engine/tuning/robust/starts.h"
#include "tests/engine/tuning/random_plants.h"

namespace tunewright::test {

struct DesignTask {
    Plant plant;
    double M = 1.4;  ///< limit of Ms and Mt
    std::string objective = "load_iae";
};

inline Expected<TunedController> designed(const DesignTask& task, const std::string& search) {
    MethodOptions options;
    options.set("Ms", task.M);
    options.set("Mt", task.M);
    options.set("objective", task.objective);
    options.set("search", search);
    return find_method("robust")->tune({task.plant, *LinearPlant::make(task.plant), std::nullopt}, options, {});
}

/// The problem of a design. `linear` must outlive it.
inline robust::DesignProblem problem_of(const DesignTask& task, const LinearPlant& linear, const IdealPid& design) {
    robust::DesignProblem problem;
    problem.plant = &linear;
    problem.sign = design.Kp < 0 ? -1 : 1;
    problem.limits.Ms = problem.limits.Mt = task.M;
    if (std::abs(design.filter.Tf / design.Td / 0.1 - 1) < 1e-9)
        problem.filter.Tf_over_Td = 0.1;
    else
        problem.filter.Tf = design.filter.Tf;
    if (task.objective == "load_ie") problem.objective = robust::Objective::load_ie;
    if (task.objective == "setpoint_iae") problem.objective = robust::Objective::setpoint_iae;
    if (task.objective == "weighted") problem.objective = robust::Objective::weighted;
    return problem;
}

inline robust::DesignPoint point_of(const IdealPid& pid) {
    return {std::log(std::abs(pid.Kp)), std::log(pid.Ti), std::log(pid.Td)};
}

/// The cost to five digits or more; empty if a limit is exceeded by more than the product's own tolerance.
inline std::optional<double> checked_cost(const robust::DesignProblem& problem, const robust::DesignPoint& x) {
    if (robust::excess_on(*problem.plant, problem, x, {.step = 0.05, .density = 60}) > 2e-5) return std::nullopt;
    const double cost = robust::log_cost(problem, x, 1e-6);
    return std::isfinite(cost) ? std::optional(std::exp(cost)) : std::nullopt;
}

/// The smallest cost that quadratic programming reaches from `count` random feasible points of the (Ti, Td) plane.
inline std::optional<double> best_from_random_starts(const robust::DesignProblem& problem, int count,
                                                     std::uint64_t seed) {
    const robust::Sweep sweep(problem, robust::reference_frequency(problem));
    const double unit = 1 / sweep.reference();
    Random random(seed);
    std::optional<double> best;
    for (int tries = 0, started = 0; started < count && tries < 20 * count; ++tries) {
        const double Ti = unit * random.log_uniform(0.05, 100), Td = unit * random.log_uniform(0.01, 10);
        const auto gains = robust::feasible_gains(sweep, Ti, Td);
        if (gains.empty()) continue;
        ++started;
        const double Kp = gains[static_cast<std::size_t>(random.whole(0, static_cast<int>(gains.size()) - 1))].Kp;
        const auto found = robust::minimise(
            sweep, problem, {std::log(Kp * random.uniform(0.5, 1)), std::log(Ti), std::log(Td)}, {}, {});
        const auto cost = std::isfinite(found.log_cost) ? checked_cost(problem, found.x) : std::nullopt;
        if (cost && !(best && *best <= *cost)) best = cost;
    }
    return best;
}

/// For every search, both parts of a weighted objective are relative to the same optima; other objectives are
/// unchanged.
inline void set_reference_optima(const DesignTask& task, robust::DesignProblem& problem) {
    if (task.objective != "weighted") return;
    for (const char* part : {"load_iae", "setpoint_iae"}) {
        DesignTask alone = task;
        alone.objective = part;
        const auto tuned = designed(alone, "fast");
        if (!tuned) continue;
        const robust::DesignProblem its = problem_of(alone, *problem.plant, tuned->controller);
        (alone.objective == "load_iae" ? problem.load_optimum : problem.setpoint_optimum) =
            std::exp(robust::log_cost(its, point_of(tuned->controller), 1e-6));
    }
}

}  // namespace tunewright::test
