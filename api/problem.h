// application/problem+json (RFC 9457): what a client is told when something cannot be done.
#pragma once

#include <string>
#include <vector>

#include "engine/error.h"

namespace tunewright::api {

struct FieldError {
    std::string pointer;  ///< JSON Pointer into the request, e.g. "/plant/L"
    std::string detail;   ///< value, rule, cure
};

struct Problem {
    int status = 500;
    std::string type = "about:blank";  ///< names the cause, e.g. "invalid-request", "no-feasible-controller"
    std::string title;
    std::string detail;
    std::vector<FieldError> errors;
    std::string instance;  ///< optional
};

/// The one table from the engine's error kinds to status, type and title.
Problem to_problem(const Error& error);

std::string to_json(const Problem& problem);

}  // namespace tunewright::api
