#include "server/routes/request_checks.h"

#include <algorithm>
#include <utility>

#include "api/csv/text.h"
#include "api/json/json.h"
#include "server/http/app/negotiation.h"
#include "server/http/app/problems.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kMaxKeyLength = 200;
constexpr std::size_t kCells = 5;  // memory of the numbers of a file, relative to its bytes
constexpr std::size_t kTree = 36;  // memory of JSON at most, relative to its bytes: [{"":0},...]

/// The bytes of the texts in a JSON body, each of which may be a file.
std::size_t texts_of(std::string_view json) {
    std::size_t bytes = 0;
    bool quoted = false;
    for (std::size_t at = 0; at < json.size(); ++at) {
        if (json[at] == '"') quoted = !quoted;
        if (!quoted || json[at] == '"') continue;
        ++bytes;
        if (json[at] == '\\' && at + 1 < json.size()) ++at, ++bytes;
    }
    return bytes;
}

}  // namespace

std::size_t handling_weight(const http::Request& request) {
    const std::size_t bytes = request.body.size();
    if (!http::sends_json(request)) return (kStoredCopies + kCells) * bytes;
    const std::size_t tree = api::tree_size(request.body);
    if (tree > api::kMaxTree) return 0;  // a body that will be refused needs no memory
    return kStoredCopies * bytes + tree + kCells * texts_of(request.body);
}

std::string fit_body(std::size_t& max_body, std::size_t memory) {
    constexpr std::size_t any = 1 + kStoredCopies + kCells;  // memory of any body, relative to its bytes; JSON needs
                                                             // more
    const std::size_t half = memory / 2, fits = half / (any + kTree);
    const std::size_t asked = max_body, max = fits <= api::kMaxTree / kTree ? fits : (half - api::kMaxTree) / any;
    if (asked <= max) return {};
    max_body = max;
    const auto kib = [](std::size_t bytes) { return std::to_string(bytes >> 10) + "KiB"; };
    return "--max-body is lowered from " + kib(asked) + " to " + kib(max) +
           ", the largest whose answer needs at most half of --memory, " + kib(memory) +
           ". Give more --memory for larger bodies.";
}

std::optional<http::Response> refuse_form(const http::Request& request) {
    if (http::accepts(request, "application/json") || http::accepts(request, "application/problem+json"))
        return std::nullopt;
    return http::problem_response(406, "The answer is application/json, which the Accept field does not allow.");
}

std::optional<http::Response> refuse_body(const http::Request& request) {
    if (http::sends_json(request)) return std::nullopt;
    return http::problem_response(415, "The body must be JSON, with Content-Type: application/json.");
}

std::optional<http::Response> refuse_call(const http::Request& request) {
    if (auto refusal = refuse_body(request)) return refusal;
    return refuse_form(request);
}

std::optional<http::Response> refuse_key(const std::string& key) {
    if (key.size() <= kMaxKeyLength) return std::nullopt;
    return http::problem_response(422, "The Idempotency-Key has " + std::to_string(key.size()) +
                                           " characters; at most " + std::to_string(kMaxKeyLength) + " are accepted.");
}

http::Response client_gone() {
    http::Response response = http::problem_response(499, "The client closed its connection before the answer.");
    response.close = true;
    return response;
}

http::Response response_of(api::Answer answer) {
    http::Response response;
    response.status = answer.status;
    response.body = std::move(answer.body);
    response.set("Content-Type", answer.status >= 400 ? "application/problem+json" : "application/json");
    return response;
}

api::Problem bad_parameters(const char* of) {
    return http::problem(422, std::string("The parameters of the ") + of + " are not valid.");
}

void refuse_parameter(api::Problem& problem, const std::string& name, const std::string& value,
                      const std::string& rule) {
    std::string name_storage, value_storage;
    const std::string shown_name(api::utf8_text(name, name_storage));
    problem.errors.push_back({"/" + api::pointer_segment(shown_name),
                              shown_name + " is \"" +
                                  std::string(api::utf8_text(std::string_view(value).substr(0, 64), value_storage)) +
                                  "\"; " + rule});
}

}  // namespace tunewright::server
