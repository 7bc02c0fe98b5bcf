// A plant given as a text, wherever a plant is expected, and the call that parses it.
#pragma once

#include "api/contract/plant/plant.h"
#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/plant/typed/typed_plant.h"

namespace tunewright::api {

/// The message of a text's reader as a sentence: it begins with a capital.
std::string as_sentence(std::string message);

/// Reads a text as a plant in the request's unit of time, which the reader knows; empty after a fault, which the reader
/// then has.
std::optional<TypedPlant> read_typed_plant(const std::string& text, Reader& reader);

/// A plant in a request: its object, or a text of a linear one. Written as objects.
Codec<Plant> plant_or_text();
Codec<PlantModel> plant_model_or_text();

/// The request and the answer of POST /v1/plants/parse.
struct PlantQuestion {
    std::optional<Units> units = {};
    std::optional<Plant> plant = {};
    std::optional<typed::Formula> formula = {};  ///< of a text, factored as it was written
    bool unfinished = false;                     ///< the user is still typing: a fault is a normal answer
    std::optional<std::string> fault = {};       ///< in place of the plant
};

const Description<PlantQuestion>& plant_question_contract();
const Description<PlantQuestion>& plant_answer_contract();

}  // namespace tunewright::api
