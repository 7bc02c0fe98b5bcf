// Jobs and calls that check loops in operation.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/contract/check/check_request.h"
#include "api/historian/tagged_loop.h"
#include "api/outcome.h"
#include "engine/progress.h"

namespace tunewright::api {

/// The answer to a request whose hash is known.
JobOutcome check_outcome(CheckRequest request, std::string_view hash, const RunControl& control);

Answer check_call(std::string_view body, const RunControl& control);  ///< POST /v1/check

/// Loops from files (api/historian), without a request around them.
struct RecordedLoops {
    std::vector<TaggedLoop> loops;
    std::vector<LoopFacts> facts;          ///< of each loop; empty: nothing is known
    std::vector<std::string> notes;        ///< findings about the files
    std::optional<std::string> time_unit;  ///< of their times and of the answer; empty: s
    bool settings = false;                 ///< as in CheckRequest
};

/// The answer about them, as that of a job whose requests are those of loop_request(); it has no request_hash. What was
/// found on reading a loop is among the remarks on its record.
JobOutcome check_recorded(RecordedLoops recorded, const RunControl& control);

/// True for the text of a request that is a check.
bool is_check_text(std::string_view request);

/// One request from a text of requests, each in a line of its own (NDJSON): the loops of all of them, and the other
/// members of the first. A single request is unchanged. 400 if a line is not JSON, 422 if its other
/// members differ.
std::variant<std::string, Problem> joined_requests(std::string_view text);

}  // namespace tunewright::api
