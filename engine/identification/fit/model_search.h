// Which structure, with which disturbances, explains a record.
#pragma once

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
