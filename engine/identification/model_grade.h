// The reliability of a model: the single conclusion that verdicts, reports and lists show.
#pragma once

#include <optional>

#include "engine/identification/identify.h"

namespace tunewright {

/// Verdict, page, report and terminal show this conclusion and do not draw their own.
enum class ModelGrade {
    good,      ///< no objection to it
    usable,    ///< with care: it has warnings about the record or the model
    doubtful,  ///< it does not explain its record, or a warning says that it may be another plant
};

/// Below this fit, in percent, a model does not explain its record: the residual has 0.3 of y's standard deviation.
inline constexpr double kMinFitPercent = 70;
/// The same if the residual is not noise (warning structured-residuals), which averaging would not reduce.
inline constexpr double kMinFitPercentBiased = 90;

/// Standard deviation of the residual over that of y: 1 - fit/100.
inline double share_left_by(const IdentifiedModel& model) { return 1 - model.fit_percent / 100; }

/// `doubtful`: the model explains less than 70 % of the record's movement; or less than 90 % if the residual is not
/// noise (warning structured-residuals); or one of its warnings has the level `bad`. `usable`: it has other warnings.
ModelGrade grade_of(const IdentifiedModel& model);

/// So many points of fit below the best candidate's, a candidate is much worse: its residual is larger by 3 % of y's
/// standard deviation, which shows in a plot.
inline constexpr double kMuchWorsePercent = 3;

/// Fills `much_worse` and `undetermined` of the candidates: a time constant or dead time with a standard error above
/// the record's length is not determined by it.
void grade_candidates(IdentifiedModel& model);

/// The reason why a model is doubtful.
enum class DoubtReason {
    fit,      ///< it explains too little of its record, whatever its warnings
    warning,  ///< it explains its record, but has a warning of level `bad`
};

/// Empty for a model that is not doubtful.
std::optional<DoubtReason> reason_of_doubt(const IdentifiedModel& model);

/// "good", "usable", "doubtful".
const char* name_of(ModelGrade grade);
/// "fit", "warning".
const char* name_of(DoubtReason reason);

}  // namespace tunewright
