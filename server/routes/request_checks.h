// What calls have in common: the form of their body and of their answer, and the parameters behind the question mark.
#pragma once

#include <charconv>
#include <optional>
#include <string>

#include "api/json/problem.h"
#include "api/service.h"
#include "server/http/message.h"

namespace tunewright::server {

/// The refusal of a call that changes or computes something: 415 where the body is not JSON, 406 where the client takes
/// no JSON. Nothing where all is well.
std::optional<http::Response> refuse_call(const http::Request& request);

/// Bytes that a request with a whole body takes while it is answered: what is read from the body, and its texts on the
/// way to the store or back.
std::size_t handling_weight(const http::Request& request);

/// Copies of a request on its way to the store.
constexpr std::size_t kStoredCopies = 2;

/// Lowers --max-body where the largest body could take more than half of `memory` while it is answered; then a sentence
/// for the log, else "".
std::string fit_body(std::size_t& max_body, std::size_t memory);

/// 406 where the client takes no JSON.
std::optional<http::Response> refuse_form(const http::Request& request);

/// 422 for an Idempotency-Key that is too long.
std::optional<http::Response> refuse_key(const std::string& key);

/// For the log and the counts: nobody is there to read it. 499, as others call it.
http::Response client_gone();

/// What the facade answers, as JSON or as a problem.
http::Response response_of(api::Answer answer);

/// Most jobs or batches on a page.
inline constexpr int kLargestPage = 200;

/// 422 for the parameters of what is named ("list"), without a fault yet.
api::Problem bad_parameters(const char* of);

/// Adds a fault: the parameter, its value, the rule. What is no UTF-8 is shown as if it were Windows-1252: an answer is
/// always text.
void refuse_parameter(api::Problem& problem, const std::string& name, const std::string& value,
                      const std::string& rule);

/// False where the text is no whole number within the bounds.
template <class Number>
bool read_whole(const std::string& text, Number min, Number max, Number& target) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), target);
    return error == std::errc{} && end == text.data() + text.size() && target >= min && target <= max;
}

}  // namespace tunewright::server
