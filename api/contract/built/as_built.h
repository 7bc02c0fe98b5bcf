// What an entry says of the controller as it is built: the settings to type, and the loop that they make.
#pragma once

#include "api/describe/description.h"
#include "engine/request/as_built.h"

namespace tunewright::api {

/// The settings as `POST /v1/controllers/{id}/settings` answers them.
const Description<built::Fitted>& as_entered_contract();

/// {"sample_time", "robustness", "performance", "responses", "difference"}.
const Description<AsBuilt>& implemented_contract();

}  // namespace tunewright::api
