// What a record leaves open about its plant, and what that means for a design.
#pragma once

#include <optional>
#include <string>

#include "engine/evaluation/evaluation.h"
#include "engine/identification/identify.h"
#include "engine/plant/analysed_plant.h"
#include "engine/plant/plant_family.h"

namespace tunewright {

/// The 95 % confidence region of the chosen model, and beside it the best fit of every structure that the record does
/// not distinguish from its own. Error: numerical_failure where the covariance is no covariance.
Expected<PlantFamily> identified_region(const IdentifiedModel& model);

/// The model with its region as what controllers are judged on; the model alone where it has no covariance. Errors:
/// as LinearPlant::make of its plant.
Expected<AnalysedPlant> subject_of(const IdentifiedModel& model);

/// Whether some plant of the region is unstable, or beyond the limit on Ms that the method was asked for, if it was.
bool breaks_limit(const Evaluation& evaluation, std::optional<double> Ms_limit);

/// Warns where the region's worst Ms is above the limit. With a model from a record (`identified`) what the region
/// shows is the answer's own doubt, not only the user's: then the warnings may be of level bad.
void warn_of_region(Evaluation& evaluation, std::optional<double> Ms_limit, bool identified);

/// The design that holds on the region stands before the one on the model alone, and says why.
void say_choice(Evaluation& held, const Evaluation& nominal);

/// Warns where the loop's phase crossover lies beyond the band that the record excited.
void warn_of_band(Evaluation& evaluation, const std::optional<ExcitedBand>& band);

}  // namespace tunewright
