// The part of an answer that describes a record: the identified model and the quality of the record.
#pragma once

#include "api/describe/description.h"
#include "engine/identification/identify.h"

namespace tunewright::api {

struct IdentifyAnswer {
    IdentifiedModel model;
};

/// A member of every answer about a record.
const Description<IdentifiedModel>& model_contract();
/// The whole answer of POST /v1/identify.
const Description<IdentifyAnswer>& identify_answer_contract();

}  // namespace tunewright::api
