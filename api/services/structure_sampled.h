// The program of a structure's controllers on its plants, call by call.
#pragma once

#include "api/contract/structure/cascade_call.h"
#include "api/contract/structure/feedforward_call.h"
#include "api/contract/structure/interaction_call.h"
#include "api/contract/structure/level_call.h"
#include "api/contract/structure/predictor_call.h"
#include "engine/progress.h"

namespace tunewright::api {

/// The plants of a request around its controllers, with the names of the measurements.
struct SampledPlants {
    structure::SampledScene scene;
    std::vector<std::string> names;
};
Expected<SampledPlants> sampled_plants(const CascadeRequest& request, const CascadeAnswer& answer);
Expected<SampledPlants> sampled_plants(const LevelRequest& request, const LevelAnswer& answer);
Expected<SampledPlants> sampled_plants(const FeedforwardRequest& request, const FeedforwardAnswer& answer);
Expected<SampledPlants> sampled_plants(const InteractionRequest& request, const InteractionAnswer& answer);
Expected<SampledPlants> sampled_plants(const PredictorRequest& request, const PredictorAnswer& answer);

/// `answer`: as it is written. Problems: those of the program, below sampled; 422 for a step that is not there.
std::variant<SampledView, Problem> run_program(const StructureRequest& request, const Json& answer,
                                               Expected<SampledPlants> plants, const RunControl& control);

}  // namespace tunewright::api
