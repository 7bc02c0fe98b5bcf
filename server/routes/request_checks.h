// Checks that are common to calls: the form of their body and of their answer, and the query parameters.
#pragma once

#include <charconv>
#include <optional>
#include <string>

#include "api/json/problem.h"
#include "api/service.h"
#include "server/http/message.h"

namespace tunewright::server {

/// 415 if the body is not JSON.
std::optional<http::Response> refuse_body(const http::Request& request);

/// The refusal of a call that changes or computes something: 415 if the body is not JSON, 406 if the client does not
/// accept JSON. Empty if the call is acceptable.
std::optional<http::Response> refuse_call(const http::Request& request);

/// Bytes of memory for the handling of a request with a complete body: the parsed body, and its texts on the way to the
/// store or back.
std::size_t handling_weight(const http::Request& request);

/// Copies of a request on its way to the store.
constexpr std::size_t kStoredCopies = 2;

/// Lowers --max-body if the handling of the largest body could take more than half of `memory`; then returns a sentence
/// for the log, else "".
std::string fit_body(std::size_t& max_body, std::size_t memory);

/// 406 if the client does not accept JSON.
std::optional<http::Response> refuse_form(const http::Request& request);

/// 422 for an Idempotency-Key that is too long.
std::optional<http::Response> refuse_key(const std::string& key);

/// For the log and the counts: the client has disconnected. 499, as in nginx.
http::Response client_gone();

/// The answer of the facade, as JSON or as a problem.
http::Response response_of(api::Answer answer);

/// The maximum number of jobs or batches on a page.
inline constexpr int kLargestPage = 200;

/// 422 for the parameters of `of` ("list"), without a fault yet.
api::Problem bad_parameters(const char* of);

/// Adds a fault: the parameter, its value, the rule. A value that is not valid UTF-8 is shown as Windows-1252: an
/// answer is always valid text.
void refuse_parameter(api::Problem& problem, const std::string& name, const std::string& value,
                      const std::string& rule);

/// False if the text is not a whole number within the bounds.
template <class Number>
bool read_whole(const std::string& text, Number min, Number max, Number& target) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), target);
    return error == std::errc{} && end == text.data() + text.size() && target >= min && target <= max;
}

}  // namespace tunewright::server
