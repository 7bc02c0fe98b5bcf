// The replay of a record in an answer.
#pragma once

#include "api/describe/description.h"
#include "engine/request/replay/replay_entry.h"

namespace tunewright::api {

/// The recorded hour, or why it is not replayed.
const Description<ReplayedRecord>& replayed_record_contract();
/// The hour with the controller of an entry, or why that is not known.
const Description<ReplayedEntry>& replayed_entry_contract();

}  // namespace tunewright::api
