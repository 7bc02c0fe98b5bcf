#include "engine/tuning/limits.h"
#include "engine/tuning/robust/robust.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "engine/loop/worst_case.h"
#include "engine/tuning/robust/family.h"

namespace tunewright {
namespace {

using namespace robust;

constexpr int kMaxRounds = 5;  // of adding the worst plants found inside the regions
constexpr int kSamples = 48;   // of a region, looked at before the worst is followed
constexpr double kHold = 0.5;  // of a sample: the mean delay of the hold

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

/// What the product makes of a filter that nobody asked for: the firmware's own where it is compiled in, and none
/// shorter than a sample time where forward differences would let it ring or blow up.
struct OwnFilter {
    std::optional<double> fixed = {};
    double shortest = 0;
};

OwnFilter filter_of(const built::Build& build) {
    if (build.product == nullptr) return {};
    const double unit = build.context.seconds_per_time;
    OwnFilter own;
    if (const auto Tf = product::compiled_filter_time(*build.product, build.context)) own.fixed = *Tf / unit;
    if (build.product->algorithm.derivative == DerivativeRule::filtered_forward) own.shortest = build.Ts;
    return own;
}

std::function<double(double)> filter_time(const TuningProblem& tuning, const RobustOptions& options,
                                          const built::Build& build) {
    const bool sampled = build.sampled();
    const auto given = explicit_filter(options.filter, options.controller == ControllerKind::PID);
    const OwnFilter own = given && *given ? OwnFilter{} : filter_of(build);
    if (own.fixed) return [Tf = *own.fixed](double) { return Tf; };
    const auto rule = filter_rule(tuning, options.filter, options.controller == ControllerKind::PID);
    if (!rule && !sampled) return {};
    const FilterRule held = rule ? *rule : FilterRule{.Tf = {}, .Tf_over_Td = limits::kDefaultTf_over_Td};
    if (held.Tf) return [Tf = std::max(*held.Tf, own.shortest)](double) { return Tf; };
    if (held.Tf_over_Td)
        return [ratio = *held.Tf_over_Td, least = own.shortest](double Td) { return std::max(ratio * Td, least); };
    return {};
}

/// Of each region the plant inside on which the built loop exceeds a limit most, where it does.
std::vector<LinearPlant> worst_as_built(const PlantFamily& family, const built::Law& law, const built::Limits& limits,
                                        const RunControl& control) {
    const PlantCost excess = [&](const LinearPlant& plant) {
        return built::is_stable(plant, law) ? built::peaks_of(plant, law).excess(limits)
                                            : std::numeric_limits<double>::infinity();
    };
    std::vector<LinearPlant> found;
    for (const PlantRegion& region : family.regions) {
        if (region.dimension() == 0) continue;
        auto starts = region.spread(kSamples);
        const auto ends = region.ends();
        starts.insert(starts.end(), ends.begin(), ends.end());
        const WorstCase worst = find_worst_case(region, excess, starts, control.stop);
        if (!(worst.cost > limits::kMaxRelativeExcessJudged)) continue;
        if (auto plant = LinearPlant::make(region.at(worst.z))) found.push_back(std::move(*plant));
    }
    return found;
}

}  // namespace

Expected<BuiltDesign> tune_robust_as_built(const TuningProblem& tuning, const RobustOptions& options,
                                           const built::Build& build, const RunControl& control) {
    if (const auto error = built::refuse_sampling(build, tuning.linear)) return *error;
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
    std::deque<LinearPlant> inside;  // found between the members; their addresses stay
    for (const LinearPlant& other : *others) plants.push_back(&other);

    built::Wish wish;
    wish.limits = {options.Ms, options.Mt, options.Mks};
    wish.pid = options.controller == ControllerKind::PID;
    wish.sign = start->controller.Kp < 0 ? -1 : 1;
    wish.filter_time = filter_time(tuning, options, build);
    wish.filter = wish.filter_time ? FilterType::measurement_second_order : FilterType::none;
    wish.start = start->controller;
    auto fitted = built::design(build, plants, wish, control);
    for (int round = 0; fitted && tuning.family && round < kMaxRounds; ++round) {
        auto added = worst_as_built(*tuning.family, fitted->law, wish.limits, control);
        if (added.empty()) break;
        for (LinearPlant& plant : added) plants.push_back(&inside.emplace_back(std::move(plant)));
        wish.start = fitted->controller;
        fitted = built::design(build, plants, wish, control);
    }
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
