// The trade-off between servo and regulation, as answers carry it.
#pragma once

#include "api/describe/description.h"
#include "engine/evaluation/tradeoff_entry.h"

namespace tunewright::api {

const Description<TradeoffEntry>& tradeoff_contract();

}  // namespace tunewright::api
