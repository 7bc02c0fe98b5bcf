#include "engine/range/search/point_designs.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/number_text.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/robust/filter_rule.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright::range {
namespace {

/// The filter rule at one point of the range.
Expected<robust::FilterRule> rule_at(const LinearPlant& plant, const RangeOptions& options, bool pid) {
    const TuningProblem problem{.plant = Fopdt{}, .linear = plant, .dead_time_std = {}};
    return robust::filter_rule(problem, options.filter, pid);
}

Expected<robust::FilterRule> common_rule(const RangeModel& model, const RangeOptions& options, bool pid) {
    robust::FilterRule common;
    for (const double at : model.points()) {
        const auto place = model.at(at);
        if (!place) return place.error();
        if (!place->nominal) continue;
        const auto rule = rule_at(*place->nominal, options, pid);
        if (!rule) return rule.error();
        if (rule->Tf_over_Td) return robust::FilterRule{.Tf = {}, .Tf_over_Td = rule->Tf_over_Td};
        if (rule->Tf) common.Tf = std::min(*rule->Tf, common.Tf.value_or(INFINITY));
    }
    if (pid && !common.Tf) common.Tf_over_Td = limits::kDefaultTf_over_Td;
    return common;
}

}  // namespace

Error placed_in_options(Error error) {
    if (error.where.starts_with("filter")) error.where = "options/" + error.where;
    return error;
}

Expected<DesignRules> design_rules(const RangeModel& model, const RangeOptions& options) {
    const auto first = model.at(model.low());
    if (!first) return first.error();
    DesignRules rules{.pid = options.controller == ControllerKind::PID, .filter = {}, .limits = options.limits};
    if (first->nominal && first->nominal->integrators() < 0)
        return Error{ErrorKind::unstable_plant, "",
                     "The plant has a zero at s = 0: integral action cancels it and the loop cannot be stable. Use a "
                     "controller without integral action."};
    rules.sign = first->nominal ? robust::first_sign(*first->nominal) : first->measured->gain_sign();
    const auto filter = common_rule(model, options, rules.pid);
    if (!filter) return placed_in_options(filter.error());
    rules.filter = *filter;
    return rules;
}

std::string PointDesigns::named(double at) const {
    return scheduling_.name + " = " + text(at) + (scheduling_.unit.empty() ? "" : " " + scheduling_.unit);
}

Expected<PointDesign*> PointDesigns::at(double at) { return find(at, true); }

std::vector<PointDesign*> PointDesigns::known() const {
    std::vector<PointDesign*> result;
    for (const auto& [at, place] : places_) result.push_back(place.get());
    return result;
}

Expected<PointDesign*> PointDesigns::find(double at, bool from_neighbour) {
    const auto after = places_.lower_bound(at);
    if (after != places_.end() && after->first == at) return after->second.get();
    if (control_.stop.stop_requested())
        return Error{ErrorKind::cancelled, "", "The design was stopped before all points of the range were searched."};
    auto model = model_.at(at);
    if (!model) return model.error();
    auto place = std::make_unique<PointDesign>(std::move(*model), rules_);
    if (place->model().nominal && robust::first_sign(*place->model().nominal) != rules_.sign)
        return Error{ErrorKind::no_feasible_controller, "",
                     "The plant's gain has the opposite sign at " + named(at) + " than at " + named(model_.low()) +
                         ", so no controller with one sign is stable at both. Split the range where the gain changes "
                         "its sign."};
    if (!place->problem().measured)
        if (auto error = robust::without_optimum(place->problem())) {
            error->message = "At " + named(at) + ": " + error->message;
            return placed_in_options(*error);
        }
    const PointDesign* neighbour = nullptr;
    if (from_neighbour && after != places_.end()) neighbour = after->second.get();
    if (from_neighbour && after != places_.begin()) {
        const PointDesign* before = std::prev(after)->second.get();
        if (neighbour == nullptr || at - before->at() <= neighbour->at() - at) neighbour = before;
    }
    if (auto error = place->find_optimum(control_, neighbour ? &neighbour->optimum() : nullptr)) {
        error->message = "At " + named(at) + ": " + error->message;
        return placed_in_options(*error);
    }
    return places_.emplace(at, std::move(place)).first->second.get();
}

}  // namespace tunewright::range
