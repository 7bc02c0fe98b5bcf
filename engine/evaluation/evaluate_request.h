// What every evaluation makes sure of before it begins.
#pragma once

#include <optional>

#include "engine/evaluation/evaluate.h"

namespace tunewright {

/// The first fault of the options ("evaluate/...") or of an Npid ("controller/..."), whatever the plant.
std::optional<Error> refuse_evaluation(const Controller& controller, const EvaluateOptions& options);

/// The same controller; an Npid without delta_r has the set-point step's size for it.
Controller resolved(Controller controller, const EvaluateOptions& options);

}  // namespace tunewright
