// Conclusions on loops around the loop: a code and its figures, no sentence.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/figure.h"
#include "engine/structure/cascade.h"
#include "engine/structure/feedforward.h"
#include "engine/structure/interaction.h"
#include "engine/structure/interaction_gains.h"
#include "engine/structure/level.h"
#include "engine/structure/predictor.h"

namespace tunewright::structure {

enum class ConclusionCode {
    unstable,  ///< the loops are not stable together

    cascade_pays,  ///< IAE: `gain_inner`, `gain_outer`, `gain_setpoint` times less than with one loop
    cascade_gains_little,
    inner_too_slow,    ///< `speed_ratio` is below `at_least`
    inner_peak_above,  ///< `Ms` exceeds `limit`
    outer_peak_above,
    valve_peak_above,

    near_lowest_rate,  ///< `rate_over_bound` is at most `at_most`
    level_above_room,  ///< `highest` exceeds `allowed`
    flow_loop_unstable,
    flow_loop_too_slow,  ///< `Ms` exceeds `limit`

    feedforward_exact,  ///< the disturbance does not move y
    feedforward_pays,   ///< IAE: `gain` times less than without
    feedforward_gains_little,
    feedforward_worse_than_none,  ///< `gain` is below 1
    gain_alone_worse_than_none,   ///< `IAE` exceeds `IAE_none`
    peak_unavoidable,             ///< `peak_bound`, of the `peak` without feedforward
    wrong_model_worse_than_none,  ///< with gains and dead times wrong by `wrong` the `IAE` exceeds `IAE_none`

    pid_does_as_well,  ///< `IAE_pid` is at most 1.02 times the predictor's `IAE`
    predictor_pays,
    limited_by_dead_time_error,  ///< the window, not Ms, bounds the design
    narrow_dead_time_window,     ///< `window` of the dead time is below `at_least`
    controller_unstable,         ///< by itself: `poles` of its own in the right half-plane

    pairing_impossible,  ///< `niederlinski`, or the lowest `relative_gain`, is negative
    other_pairing_better,
    hardly_interacting,  ///< `relative_gain` is near 1
    mu_above,            ///< `mu` exceeds `limit`
    subsets_unstable,    ///< `count` sets of loops are not stable with the others in manual
    better_than_blt,     ///< cost: `gain` times less than with the BLT settings

    decoupler_helps,            ///< cost at the same limit: `gain` times less than without
    decoupler_worse_than_none,  ///< `gain` is below 1
    decoupler_fragile,  ///< `mu`, or nothing stable, if the gain of a path is wrong by `wrong`; or `relative_gain`
};

/// The code's name: "cascade-pays".
std::string to_string(ConclusionCode code);
const std::vector<ConclusionCode>& all_conclusion_codes();

struct Conclusion {
    ConclusionCode code{};
    std::map<std::string, Figure> figures;
};
using Conclusions = std::vector<Conclusion>;

/// `single` null: not compared.
/// A cascade pays by the IAE after inner loads, in a joint design by the weighted sum over both loads.
Conclusions conclusions_on(const CascadeFigures& figures, const CascadeDesign& limits, const SingleLoop* single);
Conclusions conclusions_on(const LevelResult& result, const LevelProblem& problem);
Conclusions conclusions_on(const FeedforwardResult& result, const FeedforwardProblem& problem);
/// `pid_IAE`: of the robust PID of the same Ms.
Conclusions conclusions_on(const PredictorFigures& figures, const Figure& pid_IAE, bool limited_by_dead_time, double L);
/// `mu`: the limit; `chosen`: of the analysis' pairings; the costs are weighted sums of IAE after loads, `blt_cost`
/// infinite if it is not known.
Conclusions conclusions_on(const InteractionFigures& figures, const GainAnalysis& gains, std::size_t chosen, double mu,
                           double cost, double blt_cost);

/// `gain`: cost without the decoupler over cost with it, empty if it is not known; `relative_gain`: the largest.
Conclusions conclusions_on_decoupler(const Figure& gain, double mu, const WrongGains& wrong, double relative_gain);

}  // namespace tunewright::structure
