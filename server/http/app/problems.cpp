#include "server/http/app/problems.h"

#include <algorithm>
#include <array>

#include "api/csv/text.h"

namespace tunewright::server::http {
namespace {

struct Kind {
    int status;
    const char* type;
};

constexpr std::array kKinds{
    Kind{400, "malformed-request"},
    Kind{401, "unauthorized"},
    Kind{403, "forbidden"},
    Kind{404, "not-found"},
    Kind{405, "method-not-allowed"},
    Kind{406, "not-acceptable"},
    Kind{408, "request-timeout"},
    Kind{409, "conflict"},
    Kind{411, "length-required"},
    Kind{412, "precondition-failed"},
    Kind{413, "too-large"},
    Kind{414, "uri-too-long"},
    Kind{415, "unsupported-media-type"},
    Kind{417, "expectation-failed"},
    Kind{421, "unknown-host"},
    Kind{422, "invalid-request"},
    Kind{429, "queue-full"},
    Kind{431, "head-too-large"},
    Kind{500, "internal"},
    Kind{501, "not-implemented"},
    Kind{503, "unavailable"},
    Kind{505, "http-version"},
    Kind{507, "disk-full"},
};

}  // namespace

api::Problem problem(int status, std::string detail) {
    const auto it = std::ranges::find(kKinds, status, &Kind::status);
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
    // Sentences quote what was asked for, whatever its bytes are.
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
