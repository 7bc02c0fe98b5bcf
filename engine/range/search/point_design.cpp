#include "engine/range/search/point_design.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/tuning/limits.h"
#include "engine/tuning/robust/family.h"
#include "engine/tuning/robust/verified_search.h"

namespace tunewright::range {
namespace {

using robust::DesignPoint;

constexpr int kMaxRounds = 10;                    // rounds in which the worst plant inside a region is added
constexpr std::size_t kMaxUnfilteredMembers = 4;  // up to this number all members are kept
constexpr double kMinActiveLogRatio = -0.02;      // ln of a limit's ratio: a member below it is not active
constexpr double kPiTdFactor = 1.01;              // multiple of the least Td that a PID has in place of a PI

}  // namespace

PointDesign::PointDesign(PointModel model, const DesignRules& rules) : model_(std::move(model)) {
    problem_.pid = rules.pid;
    problem_.filter = rules.filter;
    problem_.limits = rules.limits;
    problem_.sign = rules.sign;
    if (rules.integrated || model_.measured) problem_.objective = robust::Objective::load_ie;
    if (model_.measured)
        problem_.measured = &*model_.measured;
    else
        problem_.plant = &*model_.nominal;
    pose();
}

void PointDesign::pose() {
    problem_.others = model_.members;
    sweep_.emplace(problem_, robust::reference_frequency(problem_));
}

std::optional<Error> PointDesign::find_optimum(const RunControl& control, const DesignPoint* before) {
    const RunControl quiet{.stop = control.stop, .progress = {}, .now_ms = {}};
    std::optional<robust::DesignResult> near;
    if (before != nullptr) near = robust::DesignResult{.x = *before};
    for (int round = 0; round < kMaxRounds; ++round) {
        robust::DesignProblem problem = problem_;
        const auto found = robust::verified_search(robust::SearchKind::fast, problem, std::nullopt, nullptr, quiet,
                                                   near ? &*near : nullptr);
        if (!found) return found.error();
        look_about(*problem.reference);
        optimum_ = found->x;
        optimum_log_cost_ = found->log_cost;
        // A PI that is better than any PID has ln Td = -infinity, from which no search over logarithms can start.
        const double min = std::log(kPiTdFactor * robust::kMinTd / sweep_->reference());
        optimum_is_PI_ = problem_.pid && !std::isfinite(optimum_[2]);
        if (problem_.pid) optimum_[2] = std::max(optimum_[2], min);
        if (found->stopped || !add_worst_inside(own_design(), control.stop)) break;
        near = robust::DesignResult{.x = optimum_, .curvature = found->curvature};
    }
    keep_active_members();
    return std::nullopt;
}

/// Adapts the frequency grids to the optimum: its loop may be much slower than the usual reference.
void PointDesign::look_about(double reference) {
    if (sweep_->reference() == reference) return;
    problem_.reference = reference;
    pose();
}

/// The searches that follow move the settings by a few percent: members far from every limit at the optimum would only
/// cost time. Evaluations over the range make their points again, with all members.
void PointDesign::keep_active_members() {
    if (model_.members.size() <= kMaxUnfilteredMembers) return;
    std::vector<double> nearest(model_.members.size(), kMinActiveLogRatio);
    for (const auto& peak : sweep_->peaks(own_design(), kMinActiveLogRatio))
        if (peak.plant > 0) nearest[peak.plant - 1] = std::max(nearest[peak.plant - 1], peak.value);
    std::vector<LinearPlant> kept;
    for (std::size_t i = 0; i < nearest.size(); ++i)
        (nearest[i] > kMinActiveLogRatio ? kept : set_aside_).push_back(std::move(model_.members[i]));
    model_.members = std::move(kept);
    pose();
}

DesignPoint PointDesign::own_design() const {
    return {optimum_[0], optimum_[1], optimum_is_PI_ ? -INFINITY : optimum_[2]};
}

double PointDesign::log_cost_ratio(const DesignPoint& x, double tolerance) const {
    return log_cost_ratio(evaluated(x, tolerance));
}

double PointDesign::excess(const DesignPoint& x) const { return robust::worst_excess(problem_, x); }

bool PointDesign::add_worst_inside(const DesignPoint& x, const std::stop_token& stop) {
    if (!model_.family) return false;
    auto added = robust::worst_inside(*model_.family, problem_, x, stop);
    if (added.empty()) return false;
    model_.members.insert(model_.members.end(), added.begin(), added.end());
    pose();
    return true;
}

/// A setting that differs much from the point's own optimum may come near other limits.
bool PointDesign::take_back_exceeded(const DesignPoint& x) {
    const auto exceeded = std::ranges::stable_partition(set_aside_, [&](const LinearPlant& plant) {
        return robust::excess_on(plant, problem_, x, {}) <= limits::kMaxRelativeExcessJudged;
    });
    if (exceeded.empty()) return false;
    model_.members.insert(model_.members.end(), exceeded.begin(), exceeded.end());
    set_aside_.erase(exceeded.begin(), exceeded.end());
    pose();
    return true;
}

}  // namespace tunewright::range
