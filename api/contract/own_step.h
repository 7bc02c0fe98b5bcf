// The user's own step: the part of a request, and the part of an entry.
#pragma once

#include "api/describe/description.h"
#include "engine/evaluation/own_step.h"
#include "engine/request/own_step/own_step_entry.h"

namespace tunewright::api {

/// Size, place and limits of the step, in the user's units. Its checks include those of the engine.
const Description<OwnStep>& own_step_contract();
/// The step with the controller of an entry, or the reason why that is unknown.
const Description<OwnStepEntry>& own_step_entry_contract();

}  // namespace tunewright::api
