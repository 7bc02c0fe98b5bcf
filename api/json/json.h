// The JSON type of all codecs, and a strict parser of JSON text: it also refuses text that the grammar allows but a
// request must not contain.
#pragma once

#include <initializer_list>
#include <string_view>
#include <variant>

// The library's literal "..."_json makes every source that includes it compile the parser of another JSON type, called
// or not: a tenth of a source's compile time. Here its body becomes that of a template that is never instantiated.
// NOLINTNEXTLINE(bugprone-reserved-identifier): the library's name
#define _json(...)                   \
    _json(const char*, std::size_t); \
    template <class>                 \
    nlohmann::json unread(const char* s, std::size_t n)
#include <nlohmann/json.hpp>

#include "api/json/problem.h"
#undef _json

namespace tunewright::api {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxDepth = 32;       ///< of nested objects and arrays; the contract needs 6
constexpr std::size_t kMaxMembers = 1000;   ///< of one object; the contract needs about 20
constexpr std::size_t kMaxTree = 64 << 20;  ///< bytes of the values of one text: about two million numbers

/// Parses `text`; the transport limits its length. Problems: 400 not JSON (with line and column); 413 values of more
/// than kMaxTree; 422 a member written twice, a number beyond double, nested deeper than kMaxDepth, more than
/// kMaxMembers in one object.
std::variant<Json, Problem> parse(std::string_view text);

/// Estimated bytes of memory for the values of `text`, an upper bound that exceeds the truth by at most about a
/// quarter; from one pass over its characters.
std::size_t tree_size(std::string_view text);

/// 400: the body is not valid JSON.
Problem not_json(std::string detail);

/// `text` without the white space between its tokens. `text` must be JSON.
std::string compact(std::string_view text);

/// `text` over several lines, indented by two blanks for each level; an object or array without nested ones stays on
/// one line. `text` must be JSON; tokens are copied unchanged. Ends in a newline.
std::string indented(std::string_view text);

/// `json`, an object or an array as written by compact() or a Writer, without the members of these names at any depth.
/// Everything else is copied unchanged.
std::string without_members(std::string_view json, std::initializer_list<std::string_view> names);

/// The same text for equal values: members sorted by name, numbers as the shortest text that gives the same double.
std::string canonical(const Json& value);

/// `name` as a segment of a JSON Pointer (RFC 6901): ~ becomes ~0 and / becomes ~1.
std::string pointer_segment(std::string_view name);

}  // namespace tunewright::api
