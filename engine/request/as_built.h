// What an entry's controller becomes on the user's own: the settings to type, and the loop as it then computes.
#pragma once

#include <optional>
#include <vector>

#include "engine/evaluation/evaluate_sampled.h"
#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/subject.h"
#include "engine/progress.h"
#include "engine/tuning/built/build.h"

namespace tunewright {

enum class DifferingFigure { Ms, load_IAE, overshoot };

/// `Ms_percent`, `load_IAE_percent`: by how much the loop as built lies above the entry's ideal one.
struct AsBuilt {
    built::Fitted fitted;
    BuiltLoop loop;
    Figure Ms_percent, load_IAE_percent;
    Figure overshoot_points;                    ///< the same of the set-point step's overshoot, in percent of the step
    std::vector<DifferingFigure> differs = {};  ///< those that lie so far off that it is said
};

/// Of settings that are known. `ideal`: the evaluation of the entry's controller. Errors: those of evaluating.
Expected<AsBuilt> judge_as_built(const Subject& subject, const built::Build& build, built::Fitted fitted,
                                 const EvaluateOptions& options, const Evaluation& ideal);

/// Converts the entry's controller and judges it. What the product cannot be is met by the settings with the least load
/// IAE that are at least as robust as the ideal loop (a note says so). Errors: not_representable where there are none,
/// unsupported for a nonlinear integral; those of evaluating.
Expected<AsBuilt> built_from(const Subject& subject, const built::Build& build, const EvaluateOptions& options,
                             const Evaluation& ideal, const RunControl& control);

/// Puts it beside the evaluation, with a warning where the loop as built is another one: unstable, or Ms or the load
/// IAE moved by more than 2 %. What keeps a controller from being built is a warning too: the ideal loop is answered
/// all the same.
void take_as_built(Expected<AsBuilt> built, Evaluation& evaluation, std::optional<AsBuilt>& beside);

}  // namespace tunewright
