// The replay of a record in an answer.
#pragma once

#include "api/describe/description.h"
#include "engine/request/replay/replay_entry.h"

namespace tunewright::api {

/// The record as it was, or the reason why it is not replayed.
const Description<ReplayedRecord>& replayed_record_contract();
/// The recorded time with the controller of an entry, or the reason why that is unknown.
const Description<ReplayedEntry>& replayed_entry_contract();

}  // namespace tunewright::api
