// A plant given as a text, wherever a plant is expected, and the call that says what such a text means.
#pragma once

#include "api/contract/plant/plant.h"
#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/plant/typed/typed_plant.h"

namespace tunewright::api {

/// A text as a plant in the request's unit of time, which the reader knows; nothing after a fault, which it then has.
std::optional<TypedPlant> read_typed_plant(const std::string& text, Reader& reader);

/// What a request takes as a plant: its object, or a text of a linear one. Written as objects.
Codec<Plant> plant_or_text();
Codec<PlantModel> plant_model_or_text();

/// POST /v1/plants/parse, both ways.
struct PlantQuestion {
    std::optional<Units> units = {};
    std::optional<Plant> plant = {};
    std::optional<typed::Formula> formula = {};  ///< of a text, in the factors in which it was written
    bool unfinished = false;                     ///< somebody is typing: a fault is an answer
    std::optional<std::string> fault = {};       ///< in place of the plant
};

const Description<PlantQuestion>& plant_question_contract();
const Description<PlantQuestion>& plant_answer_contract();

}  // namespace tunewright::api
