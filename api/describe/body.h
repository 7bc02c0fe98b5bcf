// Decoding of a request body by its description: every fault at once.
#pragma once

#include <string_view>
#include <utility>
#include <variant>

#include "api/describe/description.h"

namespace tunewright::api {

/// 422 for a value that the contract refuses.
template <class Request>
std::variant<Request, Problem> decode(const Json& value, const Description<Request>& contract) {
    Request request;
    Reader reader;
    contract.read(value, request, reader);
    if (auto problem = reader.problem()) return std::move(*problem);
    return request;
}

/// Decodes from the text of a body; 400 if it is not JSON.
template <class Request>
std::variant<Request, Problem> read_body(std::string_view body, const Description<Request>& contract) {
    const auto parsed = parse(body);
    if (const auto* problem = std::get_if<Problem>(&parsed)) return *problem;
    return decode(std::get<Json>(parsed), contract);
}

}  // namespace tunewright::api
