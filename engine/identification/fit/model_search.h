// Which structure, with which disturbances, explains a record.
#pragma once

#include <vector>

#include "engine/expected.h"
#include "engine/identification/fit/candidates.h"
#include "engine/progress.h"

namespace tunewright {

/// The fits of one record, on all its samples, with what chooses among them; `criteria` and `percents` belong to
/// `fits`.
struct ModelSearch {
    FitContext context;
    std::vector<Fit> fits;
    std::vector<double> criteria, percents;
    double independent = 4;  ///< samples that the best residual is worth
    StructureChoice choice;
    Disturbances disturbances;
    double part = 1;  ///< of the record, from its start: less than all for an unstable plant's long record

    const Fit& chosen() const { return fits[static_cast<std::size_t>(choice.index)]; }
};

/// Fits the structures that answer `model`. Where the best leaves a pattern: in a record that is not evenly sampled, u
/// is tried as changing midway between the rows; in one in which u moves more than once (or y creeps before it does), a
/// drift and a lasting load at an unknown time are tried, and kept if they leave a third of the sum of squares or less
/// (a thirtieth where a pattern remains).
/// An unstable plant's free run loses its digits over a long record: in relay tests that no model explains, its
/// beginning is tried.
/// Stops early when asked to; the caller looks.
ModelSearch search_models(const CleanRecord& record, ModelChoice model, bool relay, const RunControl& control);

/// The same structures once more, held to measured values of the frequency response.
void constrain(ModelSearch& search, std::vector<FrequencyConstraint> anchors, ModelChoice model,
               const RunControl& control);

/// Whether an unstable model's time constant is about the least that a record can show.
bool at_shortest_lag(const Fit& fit);

/// Root of the mean square that a fit leaves beyond noise, relative to y's standard deviation.
double unexplained_share(const FitContext& context, const Fit& fit);

}  // namespace tunewright
