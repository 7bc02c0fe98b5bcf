// The search for the structure and the disturbances that explain a record.
#pragma once

#include <array>
#include <vector>

#include "engine/expected.h"
#include "engine/identification/record/series.h"
#include "engine/identification/search/candidates.h"
#include "engine/progress.h"

namespace tunewright {

/// The fits of one record and the data for the choice among them. The record is dimensionless (clean_record.h): times
/// in lengths of the record, y in its range. `fits`, `criteria` and `percents` have equal lengths.
struct ModelSearch {
    FitContext context;
    std::vector<Fit> fits;  ///< on all samples of context.record
    std::vector<double>
        criteria;  ///< n ln(sse/n) + p ln n of each fit, n = `independent` (Schwarz 1978); less is better
    std::vector<double> percents;          ///< 100 (1 - ||residual||/||y - mean(y)||) of each fit, at most 100
    double independent = kMinIndependent;  ///< number of independent samples in the best residual
    StructureChoice choice;
    Disturbances disturbances;
    double part = 1;  ///< used share of the record, from its start: below 1 for an unstable plant's long record

    /// The fit of the chosen structure; only where choice.index >= 0.
    const Fit& chosen() const { return fits[static_cast<std::size_t>(choice.index)]; }
};

/// Thresholds of `search_models`: when it tries more, and what it keeps. They were found on simulated records with
/// known plants (tests/records: by seed, kind of test and noise) and checked on the recorded ones of tests/data. To
/// tune them: `script/bench records 1 5000` prints wrong gains without a warning, the true Ms of the default design and
/// the coverage of the intervals, before and after. Ratios are of sums of squares, before over after, unless stated
/// otherwise; correlation times in samples.
struct ModelSearchConstants {
    double explained_percent = 95;  ///< fit of a model above which moves of u are not placed again
    double as_good = 2;             ///< of the criterion: "not worth more than a bare mention" (Kass and Raftery 1995)
    double strong = 6, very_strong = 10;  ///< of the criterion (Kass and Raftery 1995, section 3.2)
    Effort rough{30, 1e-6};               ///< enough to compare criteria

    // Structures.
    int max_depth = 2;                        ///< of a structure's nesting: it starts from the results of simpler ones
    double min_noise_share = 0.8;             ///< of the known noise's variance: a lower residual is chance
    double richer_min_noise_variances = 1.3;  ///< of a residual, for trying another lag
    double richer_min_correlation = 1.5;      ///< of a residual, the same

    // Moves of u.
    int few_rows = 40;  ///< rows for each change of u: fewer hardly show when it moved
    double between_rows_max_ratio =
        1.5;                  ///< after over before: late rows are more probable, unless the fit contradicts
    int max_gap_moves = 200;  ///< each costs one fit for each possible row
    int gap_rounds = 2;
    double gap_min_ratio = 3;
    double moves_min_noise_variances = 1.15;  ///< of a residual, for estimating times within rows
    double moves_min_correlation = 1.3;       ///< of a residual, the same
    int move_rounds = 2;                      ///< because the structure may change with the times
    double moves_min_ratio = 1.01;
    double moves_min_ratio_of_pattern = 10;  ///< the same if a pattern remains
    double max_switch_work = 60'000;         ///< changes times rows
    int switch_rounds = 4;
    double switches_min_ratio = 1.5;  ///< with each switch counted as a parameter
    double min_freedom = 0.1;         ///< share of the rows that must remain as degrees of freedom
    double joint_max_ratio = 1.05;    ///< after over before: slightly worse is accepted, because the errors then
                                      ///< include the times

    // Drifts and loads.
    double min_unexplained_share = 0.005;  ///< of y's variance, for trying one
    int play_rounds = 2;                   ///< because shape and play change with each other
    double disturbance_min_ratio = 3;
    double disturbance_min_ratio_of_pattern = 30;  ///< the same if a pattern remains, because then a structure is
                                                   ///< missing
    double slow_part = 0.5;                        ///< record lengths: a longer lag may replace a drift
    double white_correlation = 2;                  ///< correlation time below which `strong` evidence is enough for a
                                                   ///< drift, else `very_strong`
    double min_drift_steps = 3;                    ///< steps of y's grid, over the record

    // Beginnings of relay tests.
    double min_unstable_lag = 0.12;  ///< record lengths: e^(1/0.12) is 4000, the growth of an error at the start
    std::array<double, 3> beginnings = {0.35, 0.12, 0.04};            ///< shares of the record
    std::array<double, 4> more_beginnings = {0.5, 0.25, 0.18, 0.07};  ///< for a whole that is fitted badly
    double badly_fitted_percent = 85;
    double max_sign_cost = 60;  ///< per cent of the fit for which a gain of the sign of the relay is preferred
    int min_beginning_changes = 3, min_beginning_samples = 40;  ///< a little more than one period of the relay
};

/// Fits the structures of `model` by output error (output_error.h), and chooses by the information criterion. If the
/// best fit leaves a pattern:
/// - in a record that is not evenly sampled, changes of u midway between the rows are tried;
/// - in a record in which u moves more than once, or y moves slowly before u, a drift and a lasting load at an unknown
///   time are tried, and kept if they reduce the sum of squares to a third (a thirtieth if a pattern remains); a load
///   that cancels a move of u before the plant has responded to it is not accepted; a play between u and the plant
///   takes their place if it explains the record as well;
/// - the free run of an unstable plant is meaningless over a long record: in relay tests that no model explains, the
///   record's beginning is tried.
///
/// If the best fit leaves more than white noise and u moves more than once, the times of the moves within their rows
/// are estimated with it (move_times.h). At the end the errors are increased for rows that may show a few moves of u
/// late (move_times.h).
///
/// `relay`: the record is of a relay test. Nothing is chosen (choice.index < 0) if the record determines no structure.
/// After a stop request the search ends early with its results so far; the caller checks the token.
ModelSearch search_models(const CleanRecord& record, ModelChoice model, bool relay, const RunControl& control);

/// The search with other fits of its structures on `context`, and the choice repeated.
ModelSearch ranked_anew(const ModelSearch& search, FitContext context, std::vector<Fit> fits, ModelChoice model);

/// Fits the same structures again with the constraints `anchors`, measured values of the frequency response.
void constrain(ModelSearch& search, std::vector<FrequencyConstraint> anchors, ModelChoice model,
               const RunControl& control);

}  // namespace tunewright
