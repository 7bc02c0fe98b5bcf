// application/problem+json answers of the transport; those of requests and jobs come from api/.
#pragma once

#include <chrono>
#include <string>

#include "api/json/problem.h"
#include "server/http/message.h"

namespace tunewright::server::http {

/// The problem for a status of HTTP (404, 405, 413, 415, 429, ...): type and title from one table.
api::Problem problem(int status, std::string detail);

/// 429 and 503 carry Retry-After.
Response problem_response(const api::Problem& problem, std::chrono::seconds retry_after = std::chrono::seconds(1));
Response problem_response(int status, std::string detail);

}  // namespace tunewright::server::http
