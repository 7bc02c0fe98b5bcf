// The one JSON type of the codecs, and strict reading of JSON text: what the grammar allows but a request must not
// contain is refused here.
#pragma once

#include <initializer_list>
#include <string_view>
#include <variant>

// The library's literal "..."_json makes every source that includes it compile the parser of another kind of JSON,
// called or not: a tenth of a source's time. Here its body becomes that of a template that nobody instantiates.
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
constexpr std::size_t kMaxTree = 64 << 20;  ///< bytes of the values of one text: some two million numbers

/// The value that `text` spells; how long it may be is the transport's business. Problems: 400 not JSON (with line and
/// column); 413 values of more than kMaxTree; 422 a member written twice, a number beyond double, nested deeper than
/// kMaxDepth, more than kMaxMembers in one object.
std::variant<Json, Problem> parse(std::string_view text);

/// Bytes that the values of `text` take in memory, to within a quarter or less than it says; from one look at its
/// characters.
std::size_t tree_size(std::string_view text);

/// 400: what was sent cannot be read as JSON.
Problem not_json(std::string detail);

/// `text` without the white space between its tokens. `text` must be JSON.
std::string compact(std::string_view text);

/// `text` over several lines, two blanks for each depth; what holds neither objects nor arrays stays on one line.
/// `text` must be JSON; everything is passed on as it is spelled. Ends in a newline.
std::string indented(std::string_view text);

/// `json`, an object or an array as compact() or a Writer spells it, without the members of these names, wherever they
/// stand. Everything else is passed on as it is spelled.
std::string without_members(std::string_view json, std::initializer_list<std::string_view> names);

/// One spelling for equal values: members sorted by name, numbers as the shortest text that gives the same double.
std::string canonical(const Json& value);

/// `name` as a segment of a JSON Pointer (RFC 6901): ~ becomes ~0 and / becomes ~1.
std::string pointer_segment(std::string_view name);

}  // namespace tunewright::api
