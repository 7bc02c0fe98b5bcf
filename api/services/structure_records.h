// Plants of a structure from records: the models, and requests with the plants in their places.
#pragma once

#include <vector>

#include "api/contract/structure/cascade_call.h"
#include "api/contract/structure/feedforward_call.h"
#include "api/contract/structure/interaction_call.h"
#include "engine/progress.h"

namespace tunewright::api {

/// A model of each record, with the findings of reading it. Errors: those of identify(), at the record.
Expected<std::vector<NamedModel>> models_of(const StructureRequest& request, const RunControl& control);

/// With the place of the record, where the error is about a plant that is from a record.
Error at_source(Error error, const StructureRequest& request);

/// Puts the models where the request needs plants. Errors: not_identifiable for a further input that moves nothing.
std::optional<Error> take_models(const std::vector<NamedModel>& models, CascadeRequest& request);
std::optional<Error> take_models(const std::vector<NamedModel>& models, FeedforwardRequest& request);
std::optional<Error> take_models(const std::vector<NamedModel>& models, InteractionRequest& request);
/// The other structures take no records.
std::optional<Error> take_models(const std::vector<NamedModel>& models, StructureRequest& request);

}  // namespace tunewright::api
