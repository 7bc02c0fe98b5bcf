#include "engine/tuning/robust/pareto_front.h"
#include "engine/plant/linear/resonance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "engine/tuning/robust/family.h"
#include "engine/tuning/robust/filter_rule.h"
#include "engine/tuning/robust/search.h"
#include "engine/tuning/robust/verified_search.h"

namespace tunewright {

using namespace robust;

namespace {

constexpr double kMaxNeighbourDistance = 1;  // largest distance (apart()) of a start
constexpr double kMaxLogDesignChange = 0.5;  // of each logarithm of a design: a larger change means another local
                                             // minimum

// Distance between two limits, which depends on how much they exceed 1.
double apart(double M, double other) { return std::abs(std::log((M - 1) / (other - 1))); }

}  // namespace

ParetoFront::ParetoFront(const TuningProblem& problem) : ParetoFront(problem, FrontLimits{}) {}

ParetoFront::ParetoFront(const TuningProblem& problem, FrontLimits terms)
    : problem_(problem), terms_(std::move(terms)) {}

bool ParetoFront::in_order(double M, double load_IAE) const {
    constexpr double kMaxEqualCostRatio = 1 + 1e-4;
    return std::ranges::all_of(known_, [&](const auto& item) {
        if (!item.second) return true;
        const double other = item.second->load_IAE;
        return item.first < M ? load_IAE <= kMaxEqualCostRatio * other : other <= kMaxEqualCostRatio * load_IAE;
    });
}

DesignPoint ParetoFront::point_of(const Design& design) const {
    const IdealPid& pid = design.controller;
    const bool PI = terms_.options.controller == ControllerKind::PI;
    return {std::log(std::abs(pid.Kp)), std::log(pid.Ti), PI ? 0 : std::log(pid.Td)};
}

/// Interpolated between the two nearest neighbours if both are near and similar; else the nearest one. No
/// extrapolation: each design has the error of the search's tolerance, which a line through two of them would amplify
/// from one to the next.
std::optional<DesignResult> ParetoFront::expected_at(double M) const {
    std::vector<std::pair<double, const Design*>> near;
    for (const auto& [other, design] : known_)
        if (design && apart(M, other) < kMaxNeighbourDistance) near.emplace_back(other, &*design);
    if (near.empty()) return std::nullopt;
    const auto nearest_two = near.begin() + std::min<std::ptrdiff_t>(2, std::ssize(near));
    std::partial_sort(near.begin(), nearest_two, near.end(),
                      [M](const auto& a, const auto& b) { return apart(M, a.first) < apart(M, b.first); });
    const DesignResult nearest{.x = point_of(*near[0].second), .curvature = near[0].second->curvature};
    if (near.size() < 2) return nearest;
    const DesignPoint next = point_of(*near[1].second);
    const double from = std::log(near[0].first - 1), to = std::log(near[1].first - 1);
    const double part = (std::log(M - 1) - from) / (to - from);
    if (part < 0) return nearest;
    DesignResult expected = nearest;
    for (std::size_t i = 0; i < next.size(); ++i) {
        const double change = next[i] - nearest.x[i];
        if (!(std::abs(change) < kMaxLogDesignChange)) return nearest;
        expected.x[i] += part * change;
    }
    return expected;
}

Expected<DesignResult> ParetoFront::searched(const RobustOptions& limits, const DesignResult* before,
                                             const RunControl& control, Design& design) {
    auto posed = nominal_problem(problem_, limits);
    if (!posed) return posed.error();
    if (!others_)
        others_ = terms_.on_family ? other_members(problem_, first_sign)
                                   : Expected<std::vector<LinearPlant>>(std::vector<LinearPlant>{});
    if (!*others_) return others_->error();
    std::vector<LinearPlant>& others = **others_;
    posed->others = others;
    if (auto error = without_optimum(*posed)) return *error;
    design.warnings.clear();
    auto found = terms_.on_family ? search_everywhere(SearchKind::fast, problem_, *posed, others, std::nullopt, nullptr,
                                                      control, before, design.warnings)
                                  : verified_search(SearchKind::fast, *posed, std::nullopt, nullptr, control, before);
    if (found) {
        design.controller = controller_at(*posed, found->x);
        design.load_IAE = std::exp(found->log_cost);
        design.curvature = found->curvature;
    }
    return found;
}

Expected<ParetoFront::Design> ParetoFront::at(double M, const RunControl& control) {
    if (const auto same = known_.find(M); same != known_.end()) return same->second;
    RobustOptions limits = terms_.options;
    limits.Ms = M;
    limits.Mt = terms_.Mt.value_or(M);
    Design design;
    // A neighbour's local minimum need not be the best: for a resonant plant, or one with zeros, all are searched for
    // each limit.
    const bool valleys = !problem_.linear.zeros().empty() ||
                         (terms_.options.controller == ControllerKind::PID && is_resonant(problem_.linear));
    const auto before = valleys ? std::nullopt : expected_at(M);
    auto found = searched(limits, before ? &*before : nullptr, control, design);
    if (before && (!found || !in_order(M, design.load_IAE))) found = searched(limits, nullptr, control, design);
    if (found && found->stopped)
        return Error{ErrorKind::cancelled, "", "The job was stopped before this optimum was found."};
    if (!found && found.error().kind == ErrorKind::cancelled) return found.error();
    return known_.emplace(M, found ? Expected<Design>(std::move(design)) : Expected<Design>(found.error()))
        .first->second;
}

}  // namespace tunewright
