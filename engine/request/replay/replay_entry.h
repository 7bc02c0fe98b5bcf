// The replay of a record in an answer: the recorded time as it was, and with the controller of each entry.
#pragma once

#include <optional>
#include <vector>

#include "engine/simulation/replay/replay_figures.h"

namespace tunewright {

enum class ReplayRefusal {
    // for the record
    manual,          ///< no controller moved u: there is no control error
    manual_rows,     ///< in a part of the rows no controller moved u
    feedback,        ///< nothing but the feedback moved u: the model may be that of the controller
    no_set_point,    ///< the set point is not recorded: the error is unknown
    doubtful_model,  ///< a warning of level bad says that the model may be that of another plant
    unknown_region,  ///< the model has no standard errors, so that the error of a replay is unknown
    coarse_rows,     ///< the rows are too far apart for the plant
    no_error,        ///< y - r is the noise of y alone, which no settings change
    // for an entry
    no_law,     ///< a nonlinear integral
    unstable,   ///< the loop is unstable on the model or on a plant that fits the record
    wide_band,  ///< the plants that fit the record leave the ratio open
};

/// y and u of one run at ReplayedRecord::t, as many points as the request asks for.
struct ReplayTrace {
    std::vector<double> y, u;
};

/// The recorded time as it was.
struct ReplayedRecord {
    std::optional<ReplayRefusal> refused;  ///< if set, the rest is meaningless
    double from = 0, to = 0;               ///< time of the first and of the last row
    ReplayFigures figures;
    std::vector<double> t, r;  ///< times of the traces, and the set point there
    ReplayTrace trace;
};

/// The recorded time with one controller. Ratios are relative to the record.
struct ReplayedEntry {
    std::optional<ReplayRefusal> refused;  ///< if set, the rest is meaningless
    ReplayFigures figures;
    double IAE_ratio = 0, IAE_ratio_low = 0, IAE_ratio_high = 0;  ///< 0 < low <= ratio <= high
    std::optional<double> travel_ratio;                           ///< empty if the recorded u does not move
    ReplayTrace trace;
};

/// "manual", "no-set-point", ...
const char* name_of(ReplayRefusal refusal);
/// The reason and the cure in one or two sentences.
const char* reason_of(ReplayRefusal refusal);

}  // namespace tunewright
