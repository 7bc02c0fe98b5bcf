// The replay of a record in an answer: of the hour as it was, and of each entry.
#pragma once

#include <optional>
#include <vector>

#include "engine/simulation/replay/hour_figures.h"

namespace tunewright {

enum class ReplayRefusal {
    // of the record
    manual,          ///< no controller moved u: the error is not a loop's
    feedback,        ///< nothing but the feedback moved u: the model may be its controller's
    no_set_point,    ///< the set point is not recorded: the error is not known
    doubtful_model,  ///< a warning of level bad says that it may be another plant
    unknown_region,  ///< the model has no standard errors: nor has the claim
    no_error,        ///< y - r is the noise of y alone: no settings change that
    // of an entry
    no_law,        ///< a nonlinear integral
    unstable,      ///< the loop is unstable on the model, or on a plant that the record leaves possible
    wide_band,     ///< the record leaves the ratio open
};

/// Thinned to the points that the request asks for; y and u of one run, at the times of ReplayedRecord::trace.
struct HourTrace {
    std::vector<double> y, u;
};

/// The recorded hour.
struct ReplayedRecord {
    std::optional<ReplayRefusal> refused;
    double from = 0, to = 0;  ///< time of its first and last row
    HourFigures figures;
    std::vector<double> t, r;  ///< of the traces
    HourTrace trace;
};

/// One controller over the hour. Ratios are to the recorded hour.
struct ReplayedEntry {
    std::optional<ReplayRefusal> refused;  ///< then nothing else counts
    HourFigures figures;
    double IAE_ratio = 0, IAE_ratio_low = 0, IAE_ratio_high = 0;  ///< 0 < low <= ratio <= high
    std::optional<double> travel_ratio;  ///< empty where the recorded u does not move
    HourTrace trace;
};

/// "manual", "no-set-point", ...
const char* name_of(ReplayRefusal refusal);
/// Why, and what to do: one or two sentences.
const char* reason_of(ReplayRefusal refusal);

}  // namespace tunewright
