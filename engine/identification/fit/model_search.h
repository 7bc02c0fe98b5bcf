// Which structure, with which disturbances, explains a record.
#pragma once

#include <array>
#include <vector>

#include "engine/expected.h"
#include "engine/identification/fit/candidates.h"
#include "engine/identification/record/series.h"
#include "engine/progress.h"

namespace tunewright {

/// The fits of one record with what chooses among them. The record is dimensionless (clean_record.h): times in lengths
/// of the record, y in its range. `fits`, `criteria` and `percents` have equal lengths.
struct ModelSearch {
    FitContext context;
    std::vector<Fit> fits;  ///< on all samples of context.record
    std::vector<double>
        criteria;  ///< n ln(sse/n) + p ln n of each fit, n = `independent` (Schwarz 1978); less is better
    std::vector<double> percents;          ///< 100 (1 - ||residual||/||y - mean(y)||) of each fit, at most 100
    double independent = kMinIndependent;  ///< samples that the best residual is worth
    StructureChoice choice;
    Disturbances disturbances;
    double part = 1;  ///< share of the record, from its start: below 1 for an unstable plant's long record

    /// The fit of the chosen structure; only where choice.index >= 0.
    const Fit& chosen() const { return fits[static_cast<std::size_t>(choice.index)]; }
};

/// When `search_models` looks further, and what it keeps. Found on made records whose plants are known (tests/records:
/// of seeds, by kind of test and noise) and held on the recorded ones of tests/data. To tune again: `script/bench
/// records 1 5000` prints wrong gains in silence, the true Ms of the default design and the coverage of the intervals
/// before and after. Ratios are of sums of squares, before over after, where nothing else is said; correlation times in
/// samples.
struct ModelSearchConstants {
    double explained_percent = 95;  ///< fit of a model from which on moves of u are no longer placed anew
    double as_good = 2;             ///< of the criterion: "not worth more than a bare mention" (Kass and Raftery 1995)
    double strong = 6, very_strong = 10;  ///< of the criterion (Kass and Raftery 1995, section 3.2)
    Effort rough{30, 1e-6};               ///< enough to compare criteria

    // Structures.
    int max_depth = 2;                        ///< of a structure's nesting: it starts from the ends of lesser ones
    double min_noise_share = 0.8;             ///< of the known noise's variance: a lower residual is luck
    double richer_min_noise_variances = 1.3;  ///< of a residual, for another lag to be tried
    double richer_min_correlation = 1.5;      ///< of a residual, the same

    // Moves of u.
    int few_rows = 40;  ///< for each change of u: they hardly show when it moved
    double between_rows_max_ratio =
        1.5;                  ///< after over before: late rows are the likelier, unless the fit says otherwise
    int max_gap_moves = 200;  ///< each costs a fit for each row that it may belong to
    int gap_rounds = 2;
    double gap_min_ratio = 3;
    double moves_min_noise_variances = 1.15;  ///< of a residual, for times within rows to be estimated
    double moves_min_correlation = 1.3;       ///< of a residual, the same
    int move_rounds = 2;                      ///< the structure may be another one with the times estimated
    double moves_min_ratio = 1.01;
    double moves_min_ratio_of_pattern = 10;  ///< where a pattern remains
    double max_switch_work = 60'000;         ///< changes times rows
    int switch_rounds = 4;
    double switches_min_ratio = 1.5;  ///< after each switch was counted as a parameter
    double min_freedom = 0.1;         ///< share of the rows that the switches leave as degrees of freedom
    double joint_max_ratio = 1.05;    ///< after over before: an estimate whose errors are counted is worth it

    // Drifts and loads.
    double min_unexplained_share = 0.005;  ///< of y's variance, for one to be tried
    double disturbance_min_ratio = 3;
    double disturbance_min_ratio_of_pattern = 30;  ///< where a pattern remains: a structure is missing instead
    double slow_part = 0.5;                        ///< record lengths: a lag from it on may stand in for a drift
    double white_correlation = 2;                  ///< below it `strong` evidence does for a drift, else `very_strong`
    double min_drift_steps = 3;                    ///< of y's grid, over the record

    // Beginnings of relay tests.
    double min_unstable_lag = 0.12;  ///< record lengths: e^(1/0.12) is 4000 times an error at the start
    std::array<double, 3> beginnings = {0.35, 0.12, 0.04};      ///< of the record
    int min_beginning_changes = 3, min_beginning_samples = 40;  ///< a period of the relay and some more
};

/// Fits the structures that answer `model`, by output error (output_error.h), and chooses by the information criterion.
/// Where the best fit leaves a pattern:
/// - in a record that is not evenly sampled, u is tried as changing midway between the rows;
/// - in one in which u moves more than once, or y creeps before u does, a drift and a lasting load at an unknown time
///   are tried, and kept if they leave a third of the sum of squares or less (a thirtieth where a pattern remains);
///   No load is taken that takes back a move of u before the plant has answered it;
/// - an unstable plant's free run loses its digits over a long record: in relay tests that no model explains, the
///   record's beginning is tried.
///
/// If the best fit leaves more than white noise and u moves more than once, the times of the moves within their rows
/// are estimated with it (move_times.h). Rows that may show a few moves of u late are allowed for at the end
/// (move_times.h).
///
/// `relay`: the record is of a relay test. Nothing is chosen (choice.index < 0) where the record determines no
/// structure. When control.stop asks for it the search ends early with what it has; the caller looks at the token.
ModelSearch search_models(const CleanRecord& record, ModelChoice model, bool relay, const RunControl& control);

/// The search with other fits of its structures in place of its own, on `context`, and the choice made again.
ModelSearch ranked_anew(const ModelSearch& search, FitContext context, std::vector<Fit> fits, ModelChoice model);

/// Fits the same structures once more, held to `anchors`, measured values of the frequency response.
void constrain(ModelSearch& search, std::vector<FrequencyConstraint> anchors, ModelChoice model,
               const RunControl& control);

}  // namespace tunewright
