// The answer about one checked loop. It is written, and read back for the judgement of a batch.
#pragma once

#include "api/describe/description.h"
#include "engine/request/check/ask_check.h"

namespace tunewright::api {

const Description<CheckedLoop>& loop_check_contract();

Codec<check::Verdict> check_verdict();
Codec<check::ActionCode> check_action();

}  // namespace tunewright::api
