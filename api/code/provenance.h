// The origin of a program's controller, as lines of its head comment.
#pragma once

#include "api/json/json.h"
#include "engine/code/print.h"

namespace tunewright::api {

/// Lines of the head comment from a result, one of its entries, and the request (null if it is not known).
code::Provenance provenance_of(const Json& result, const Json& entry, const Json& request);

/// Lines of the head comment from a range's answer: its scheduling variable, and the worst place of the schedule.
code::Provenance provenance_of_schedule(const Json& result, const Json& request);

}  // namespace tunewright::api
