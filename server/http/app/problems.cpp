#include "server/http/app/problems.h"

#include <algorithm>
#include <array>

#include "api/csv/text.h"

namespace tunewright::server::http {
namespace {

struct ProblemKind {
    int status;
    const char* type;
};

constexpr std::array kKinds{
    ProblemKind{400, "malformed-request"},
    ProblemKind{401, "unauthorized"},
    ProblemKind{403, "forbidden"},
    ProblemKind{404, "not-found"},
    ProblemKind{405, "method-not-allowed"},
    ProblemKind{406, "not-acceptable"},
    ProblemKind{408, "request-timeout"},
    ProblemKind{409, "conflict"},
    ProblemKind{411, "length-required"},
    ProblemKind{412, "precondition-failed"},
    ProblemKind{413, "too-large"},
    ProblemKind{414, "uri-too-long"},
    ProblemKind{415, "unsupported-media-type"},
    ProblemKind{417, "expectation-failed"},
    ProblemKind{421, "unknown-host"},
    ProblemKind{422, "invalid-request"},
    ProblemKind{429, "queue-full"},
    ProblemKind{431, "head-too-large"},
    ProblemKind{500, "internal"},
    ProblemKind{501, "not-implemented"},
    ProblemKind{503, "unavailable"},
    ProblemKind{505, "http-version"},
    ProblemKind{507, "disk-full"},
};

}  // namespace

api::Problem problem(int status, std::string detail) {
    const auto it = std::ranges::find(kKinds, status, &ProblemKind::status);
    api::Problem made;
    made.status = status;
    made.type = it == kKinds.end() ? "about:blank" : it->type;
    made.title = reason_phrase(status);
    made.detail = std::move(detail);
    return made;
}

Response problem_response(const api::Problem& problem, std::chrono::seconds retry_after) {
    Response response;
    response.status = problem.status;
    // Sentences quote the request, whose bytes may be anything.
    const std::string body = api::to_json(problem);
    std::string storage;
    response.body = api::utf8_text(body, storage);
    response.set("Content-Type", "application/problem+json");
    if (problem.status == 429 || problem.status == 503)
        response.set("Retry-After", std::to_string(retry_after.count()));
    return response;
}

Response problem_response(int status, std::string detail) {
    return problem_response(problem(status, std::move(detail)));
}

}  // namespace tunewright::server::http
