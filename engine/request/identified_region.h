// The uncertainty that a record leaves about its plant, and its consequences for a design.
#pragma once

#include <optional>
#include <string>

#include "engine/evaluation/evaluation.h"
#include "engine/identification/identify.h"
#include "engine/plant/analysed_plant.h"
#include "engine/plant/plant_family.h"

namespace tunewright {

/// The 95 % confidence region of the chosen model, together with the best fit of every structure that the record does
/// not distinguish from the chosen one. Error: numerical_failure if the covariance matrix is not valid.
Expected<PlantFamily> identified_region(const IdentifiedModel& model);

/// The model with its region, as the plant that controllers are evaluated on; the model alone if it has no covariance.
/// Errors: as LinearPlant::make of its plant.
Expected<AnalysedPlant> subject_of(const IdentifiedModel& model);

/// True if some plant of the region is unstable, or exceeds the limit on Ms of the method's options (if there is one).
bool breaks_limit(const std::optional<RegionFigures>& region, std::optional<double> Ms_limit);

/// Warns where the region's worst Ms is above the limit. With a model from a record (`identified`) the region is a
/// result of this answer and not an input of the user: then the warnings may be of level bad.
void warn_of_region(Evaluation& evaluation, const std::optional<RegionFigures>& region, std::optional<double> Ms_limit,
                    bool identified);

/// Explains why the design that holds on the region stands before the one for the model alone. `alone`: the figures of
/// that one over the region.
void say_choice(Evaluation& held, const RegionFigures& alone);

/// Warns where the loop's phase crossover lies beyond the band that the record excited.
void warn_of_band(Evaluation& evaluation, const std::optional<ExcitedBand>& band);

}  // namespace tunewright
