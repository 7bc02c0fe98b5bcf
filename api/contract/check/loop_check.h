// The answer about one checked loop. It is written, and partly read back for the judgement of a batch.
#pragma once

#include "api/describe/description.h"
#include "engine/request/check/ask_check.h"

namespace tunewright::api {

const Description<CheckedLoop>& loop_check_contract();

/// For the schema: PlantChecks writes it from the texts of the results.
const Description<CheckedLoop>& loop_of_batch_contract();

/// Reads those members of a loop's answer from which a batch is judged; all others keep their defaults.
check::LoopCheck read_loop_check(const Json& loop);

/// The members cause and action, of an open object.
void write_cause_and_action(const check::LoopCheck& check, Writer& out);

Codec<check::Verdict> check_verdict();
Codec<check::ActionCode> check_action();

}  // namespace tunewright::api
