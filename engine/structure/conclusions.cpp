#include "engine/structure/conclusions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tunewright::structure {
namespace {

using enum ConclusionCode;

constexpr double kWorthwhile = 1.5;         // IAE without over IAE with the structure
constexpr double kMinSpeedRatio = 3;        // Shinskey: a secondary at least 3 to 5 times as fast
constexpr double kNearLowestRate = 1.1;     // largest rate of the outflow over the bound for any controller
constexpr double kAsWell = 1.02;            // IAE of the PID over that of the predictor
constexpr double kMinWindow = 0.25;         // of the dead time: how well it is known at best in a plant
constexpr double kHardlyInteracting = 0.1;  // |relative gain - 1|, at steady state and near the crossovers
constexpr double kDecouplerHelps = 1.1;     // cost without over cost with the decoupler
constexpr double kFragileMu = 1.5;          // mu with a wrong gain over mu
constexpr double kMuchBetterPairing = 0.5;  // distance of the better pairing over that of the chosen one

struct CodeName {
    ConclusionCode code;
    const char* name;
};
constexpr CodeName kNames[] = {
    {unstable, "unstable"},
    {cascade_pays, "cascade-pays"},
    {cascade_gains_little, "cascade-gains-little"},
    {inner_too_slow, "inner-too-slow"},
    {inner_peak_above, "inner-peak-above"},
    {outer_peak_above, "outer-peak-above"},
    {valve_peak_above, "valve-peak-above"},
    {near_lowest_rate, "near-lowest-rate"},
    {level_above_room, "level-above-room"},
    {flow_loop_unstable, "flow-loop-unstable"},
    {flow_loop_too_slow, "flow-loop-too-slow"},
    {feedforward_exact, "feedforward-exact"},
    {feedforward_pays, "feedforward-pays"},
    {feedforward_gains_little, "feedforward-gains-little"},
    {feedforward_worse_than_none, "feedforward-worse-than-none"},
    {gain_alone_worse_than_none, "gain-alone-worse-than-none"},
    {peak_unavoidable, "peak-unavoidable"},
    {wrong_model_worse_than_none, "wrong-model-worse-than-none"},
    {pid_does_as_well, "pid-does-as-well"},
    {predictor_pays, "predictor-pays"},
    {limited_by_dead_time_error, "limited-by-dead-time-error"},
    {narrow_dead_time_window, "narrow-dead-time-window"},
    {controller_unstable, "controller-unstable"},
    {pairing_impossible, "pairing-impossible"},
    {other_pairing_better, "other-pairing-better"},
    {hardly_interacting, "hardly-interacting"},
    {mu_above, "mu-above"},
    {subsets_unstable, "subsets-unstable"},
    {better_than_blt, "better-than-blt"},
    {decoupler_helps, "decoupler-helps"},
    {decoupler_worse_than_none, "decoupler-worse-than-none"},
    {decoupler_fragile, "decoupler-fragile"},
};

bool above(double peak, double limit) { return peak > limit * (1 + limits::kMaxRelativeExcessShown); }

void add_peak(Conclusions& out, ConclusionCode code, double peak, double limit) {
    if (above(peak, limit)) out.push_back({code, {{"Ms", peak}, {"limit", limit}}});
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double or_infinite(const Figure& IAE) { return IAE.value_or(kInfinity); }

/// without/with; empty where both are infinite.
std::optional<double> gain_of(double without, double with) {
    if (std::isinf(without) && std::isinf(with)) return std::nullopt;
    return without / with;
}

/// The purpose of a cascade: the IAE after inner loads, or the cost of a joint design.
double weighed(const LoadFigures& inner, const LoadFigures& outer, const CascadeDesign& design) {
    if (!design.joint) return or_infinite(inner.IAE);
    return (design.weight_inner > 0 ? design.weight_inner * or_infinite(inner.IAE) : 0) +
           (design.weight_outer > 0 ? design.weight_outer * or_infinite(outer.IAE) : 0);
}

}  // namespace

std::string to_string(ConclusionCode code) { return std::ranges::find(kNames, code, &CodeName::code)->name; }

const std::vector<ConclusionCode>& all_conclusion_codes() {
    static const std::vector<ConclusionCode> codes = [] {
        std::vector<ConclusionCode> out;
        for (const CodeName& row : kNames) out.push_back(row.code);
        return out;
    }();
    return codes;
}

Conclusions conclusions_on(const CascadeFigures& figures, const CascadeDesign& limits, const SingleLoop* single) {
    if (!figures.stable) return {{unstable, {}}};
    Conclusions out;
    if (single != nullptr && single->stable) {
        const std::optional<double> gain = gain_of(weighed(single->inner_load, single->outer_load, limits),
                                                   weighed(figures.inner_load, figures.outer_load, limits));
        const std::map<std::string, Figure> gains{{"gain_inner", ratio(single->inner_load.IAE, figures.inner_load.IAE)},
                                                  {"gain_outer", ratio(single->outer_load.IAE, figures.outer_load.IAE)},
                                                  {"gain_setpoint", ratio(single->setpoint.IAE, figures.setpoint.IAE)}};
        // The gain for inner loads must outweigh a loss after outer loads or set points.
        const double lost = std::min({1.0, gains.at("gain_outer").value_or(1), gains.at("gain_setpoint").value_or(1)});
        if (gain) out.push_back({*gain * lost >= kWorthwhile ? cascade_pays : cascade_gains_little, gains});
    }
    if (figures.speed_ratio && *figures.speed_ratio < kMinSpeedRatio)
        out.push_back({inner_too_slow, {{"speed_ratio", *figures.speed_ratio}, {"at_least", kMinSpeedRatio}}});
    add_peak(out, inner_peak_above, figures.Ms_inner, limits.inner.Ms);
    add_peak(out, outer_peak_above, figures.Ms_outer, limits.outer.Ms);
    add_peak(out, valve_peak_above, figures.Ms_valve, limits.valve_limit());
    return out;
}

Conclusions conclusions_on(const LevelResult& result, const LevelProblem& problem) {
    if (problem.flow && !result.Ms) return {{flow_loop_unstable, {}}};
    Conclusions out;
    const bool with_flow = problem.flow && result.highest;
    const double highest = with_flow ? *result.highest : result.design.highest;
    const double rate = with_flow ? *result.largest_rate / result.bound : result.design.rate_over_bound;
    if (above(highest, problem.allowed))
        out.push_back({level_above_room, {{"highest", highest}, {"allowed", problem.allowed}}});
    else if (rate <= kNearLowestRate)
        out.push_back({near_lowest_rate, {{"rate_over_bound", rate}, {"at_most", kNearLowestRate}}});
    if (problem.flow) add_peak(out, flow_loop_too_slow, *result.Ms, limits::kDefaultMs);
    return out;
}

Conclusions conclusions_on(const FeedforwardResult& result, const FeedforwardProblem& problem) {
    Conclusions out;
    const auto of = [&](FeedforwardKind kind) -> const FeedforwardVariant* {
        const auto found = std::ranges::find(result.variants, kind, &FeedforwardVariant::kind);
        return found != result.variants.end() && (found->compensator || kind == FeedforwardKind::none) ? &*found
                                                                                                       : nullptr;
    };
    const FeedforwardVariant& none = *of(FeedforwardKind::none);
    const Figure& IAE_none = none.figures.IAE;
    const FeedforwardVariant* best = of(FeedforwardKind::given);
    if (best == nullptr) best = of(problem.wanted);
    if (best != nullptr) {
        const std::optional<double> gain = gain_of(or_infinite(IAE_none), or_infinite(best->figures.IAE));
        if (is_exact(best->figures, none.figures))
            out.push_back({feedforward_exact, {}});
        else if (gain)
            out.push_back({*gain >= kWorthwhile ? feedforward_pays
                           : *gain >= 1         ? feedforward_gains_little
                                                : feedforward_worse_than_none,
                           {{"gain", ratio(IAE_none, best->figures.IAE)}}});
        double worst = 0;
        for (const Figure& IAE : best->IAE_if_wrong) worst = std::max(worst, IAE.value_or(0));
        if (IAE_none && worst > *IAE_none && gain >= 1)
            out.push_back(
                {wrong_model_worse_than_none, {{"IAE", worst}, {"IAE_none", IAE_none}, {"wrong", problem.wrong}}});
    }
    if (const auto* alone = of(FeedforwardKind::gain);
        alone != nullptr && or_infinite(alone->figures.IAE) > or_infinite(IAE_none))
        out.push_back({gain_alone_worse_than_none, {{"IAE", alone->figures.IAE}, {"IAE_none", IAE_none}}});
    if (result.peak_bound > 0)
        out.push_back({peak_unavoidable, {{"peak_bound", result.peak_bound}, {"peak", std::abs(none.figures.peak)}}});
    return out;
}

Conclusions conclusions_on(const PredictorFigures& figures, const Figure& pid_IAE, bool limited_by_dead_time,
                           double L) {
    if (!figures.stable) return {{unstable, {}}};
    Conclusions out;
    if (pid_IAE && figures.load && figures.load->IAE) {
        const double IAE = *figures.load->IAE;
        out.push_back(
            {*pid_IAE <= kAsWell * IAE ? pid_does_as_well : predictor_pays, {{"IAE_pid", *pid_IAE}, {"IAE", IAE}}});
    }
    if (limited_by_dead_time) out.push_back({limited_by_dead_time_error, {{"Ms", figures.Ms}}});
    const double window = std::min(or_infinite(figures.dead_time_up), or_infinite(figures.dead_time_down));
    if (window < kMinWindow * L)
        out.push_back({narrow_dead_time_window, {{"window", window}, {"at_least", kMinWindow * L}}});
    if (figures.controller_unstable_poles > 0)
        out.push_back({controller_unstable, {{"poles", double(figures.controller_unstable_poles)}}});
    return out;
}

Conclusions conclusions_on(const InteractionFigures& figures, const GainAnalysis& gains, std::size_t chosen, double mu,
                           double cost, double blt_cost) {
    Conclusions out;
    const Pairing& pairing = gains.pairings[chosen];
    const double lowest = std::ranges::min(pairing.relative);
    if (!pairing.possible)
        out.push_back({pairing_impossible, {{"relative_gain", lowest}, {"niederlinski", pairing.niederlinski}}});
    const Pairing& best = gains.pairings.front();
    if (chosen > 0 && best.possible && (!pairing.possible || best.distance < kMuchBetterPairing * pairing.distance))
        out.push_back({other_pairing_better, {{"relative_gain", lowest}, {"other", std::ranges::min(best.relative)}}});
    if (!figures.stable) {
        out.push_back({unstable, {}});
        return out;
    }
    const auto near_one = [](double gain) { return std::abs(gain - 1) <= kHardlyInteracting; };
    if (std::ranges::all_of(pairing.relative, near_one) && std::ranges::all_of(pairing.at_crossover, near_one))
        out.push_back({hardly_interacting, {{"relative_gain", lowest}}});
    if (above(figures.mu, mu)) out.push_back({mu_above, {{"mu", figures.mu}, {"limit", mu}}});
    if (!figures.unstable_subsets.empty())
        out.push_back({subsets_unstable, {{"count", double(figures.unstable_subsets.size())}}});
    if (std::isfinite(blt_cost) && blt_cost > cost) out.push_back({better_than_blt, {{"gain", blt_cost / cost}}});
    return out;
}

Conclusions conclusions_on_decoupler(const Figure& gain, double mu, const WrongGains& wrong, double relative_gain) {
    Conclusions out;
    if (gain && *gain >= kDecouplerHelps) out.push_back({decoupler_helps, {{"gain", *gain}}});
    if (gain && *gain < 1) out.push_back({decoupler_worse_than_none, {{"gain", *gain}}});
    // A path's gain that is wrong by the share 1/relative gain makes the plant singular.
    if (!wrong.mu || *wrong.mu > kFragileMu * mu || relative_gain >= 1 / wrong.by) {
        out.push_back({decoupler_fragile, {{"wrong", wrong.by}, {"relative_gain", relative_gain}}});
        if (wrong.mu) out.back().figures["mu"] = *wrong.mu;
    }
    return out;
}

}  // namespace tunewright::structure
