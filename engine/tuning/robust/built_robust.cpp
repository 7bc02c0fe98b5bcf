#include "engine/tuning/robust/built_robust.h"

#include <cmath>

#include "engine/tuning/robust/family.h"
#include "engine/tuning/robust/filter_rule.h"

namespace tunewright {
namespace {

using namespace robust;

constexpr double kHold = 0.5;        // of a sample: the mean delay of the hold
constexpr double kTiedFilter = 0.1;  // Tf/Td where the plant suggests no filter time but the sampling bounds the gain

/// The plant as a sampled program sees it, nearly: later by half a sample and by the computation. An ideal design for
/// it is where the search starts; with any sampling it has a finite optimum.
Expected<TuningProblem> delayed(const TuningProblem& tuning, const built::Build& build) {
    TuningProblem later = tuning;
    later.family.reset();
    const double extra = kHold * build.Ts + build.computation_delay;
    std::visit([&](auto& plant) { plant.L += extra; }, later.plant);
    auto linear = LinearPlant::make(later.plant);
    if (!linear) return linear.error();
    later.linear = std::move(*linear);
    if (later.dead_time_std) *later.dead_time_std = std::min(*later.dead_time_std, extra / 2);
    return later;
}

std::function<double(double)> filter_time(const TuningProblem& tuning, const RobustOptions& options, bool sampled) {
    const auto rule = filter_rule(tuning, options.filter, options.controller == ControllerKind::PID);
    if (!rule && !sampled) return {};
    const FilterRule held = rule ? *rule : FilterRule{.Tf = {}, .Tf_over_Td = kTiedFilter};
    if (held.Tf) return [Tf = *held.Tf](double) { return Tf; };
    if (held.Tf_over_Td) return [ratio = *held.Tf_over_Td](double Td) { return ratio * Td; };
    return {};
}

}  // namespace

Expected<BuiltDesign> tune_robust_as_built(const TuningProblem& tuning, const RobustOptions& options,
                                           const built::Build& build, const RunControl& control) {
    const auto start_problem = build.sampled() ? delayed(tuning, build) : Expected<TuningProblem>(tuning);
    if (!start_problem) return start_problem.error();
    RobustOptions ideal = options;
    ideal.objective = Objective::load_iae;
    ideal.search = SearchKind::fast;
    ideal.surface = false;
    auto start = tune_robust(*start_problem, ideal, control);
    if (!start) return start.error();
    auto others = other_members(tuning, first_sign);
    if (!others) return others.error();
    std::vector<const LinearPlant*> plants{&tuning.linear};
    for (const LinearPlant& other : *others) plants.push_back(&other);

    built::Wish wish;
    wish.limits = {options.Ms, options.Mt, options.Mks};
    wish.pid = options.controller == ControllerKind::PID;
    wish.sign = start->controller.Kp < 0 ? -1 : 1;
    wish.filter_time = filter_time(tuning, options, build.sampled());
    wish.filter = wish.filter_time ? FilterType::measurement_second_order : FilterType::none;
    wish.start = start->controller;
    auto fitted = built::design(build, plants, wish, control);
    if (!fitted) return fitted.error();
    BuiltDesign design{std::move(*start), std::move(*fitted)};
    design.tuned.controller = built::continuous(design.fitted.controller);
    design.tuned.warnings.clear();
    design.tuned.Ms_limit = options.Ms;
    if (options.objective != Objective::load_iae || options.constraint != Constraint::circles)
        design.tuned.warnings.push_back({"objective-replaced",
                                         "A design for the controller as it is built minimises the load IAE under the "
                                         "circles of Ms and Mt, in place of what was asked for."});
    return design;
}

}  // namespace tunewright
