// The controllers of the contract: ideal, parallel, series and nonlinear form, with their filters.
#pragma once

#include <string>

#include "api/describe/union.h"
#include "engine/evaluation/evaluation.h"

namespace tunewright::api {

/// Chosen by `form`; ideal if it is not given.
const Union<Controller>& controller_contract();

const Description<Equivalents>& equivalents_contract();

}  // namespace tunewright::api
