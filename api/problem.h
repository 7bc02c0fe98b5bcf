// application/problem+json (RFC 9457): what a client is told when something cannot be done.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/error.h"
#include "engine/identification/record.h"

namespace tunewright::api {

struct FieldError {
    std::string pointer;  ///< JSON Pointer into the request, e.g. "/plant/L"
    std::string detail;   ///< value, rule, cure
};

/// A record as it was read, at most 2,000 of its rows: what a reader needs to see why it determines no model.
struct RecordSamples {
    std::vector<double> t, u, y;
};

struct Problem {
    int status = 500;
    std::string type = "about:blank";  ///< names the cause, e.g. "invalid-request", "no-feasible-controller"
    std::string title;
    std::string detail;
    std::vector<FieldError> errors;
    std::string instance;                      ///< optional
    std::optional<RecordSamples> record = {};  ///< of a record that was read, but not identified
};

/// The one table from the engine's error kinds to status, type and title.
Problem to_problem(const Error& error);

/// Evenly chosen rows, the first and the last among them; rows in which something is no number are left out.
RecordSamples samples_of(const Record& record);

std::string to_json(const Problem& problem);

}  // namespace tunewright::api
