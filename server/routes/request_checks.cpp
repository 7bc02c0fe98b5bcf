#include "server/routes/request_checks.h"

#include "server/http/negotiation.h"
#include "server/http/problems.h"

namespace tunewright::server {

std::optional<http::Response> refuse_form(const http::Request& request) {
    if (http::accepts(request, "application/json") || http::accepts(request, "application/problem+json"))
        return std::nullopt;
    return http::problem_response(406, "The answer is application/json, which the Accept field does not allow.");
}

std::optional<http::Response> refuse_call(const http::Request& request) {
    if (!http::sends_json(request))
        return http::problem_response(415, "The body must be JSON, with Content-Type: application/json.");
    return refuse_form(request);
}

}  // namespace tunewright::server
