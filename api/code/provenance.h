// A program as a file with the origin of its controller, as lines of its head comment.
#pragma once

#include "api/code/code.h"
#include "api/code/parameters.h"
#include "api/json/json.h"
#include "engine/code/print.h"

namespace tunewright::api {

/// Lines of the head comment from a result, one of its entries, and the request (null if it is not known).
code::Provenance provenance_of(const Json& result, const Json& entry, const Json& request);

/// Lines of the head comment from a range's answer: its scheduling variable, and the worst place of the schedule.
code::Provenance provenance_of_schedule(const Json& result, const Json& request);

/// The file in its language, with the sample time as the last line of its head.
ControllerCode printed(const code::Program& program, code::Language language, const code::Provenance& provenance,
                       const SampleTime& sample_time);

}  // namespace tunewright::api
