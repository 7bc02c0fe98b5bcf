// Content negotiation of a request: media types, conditional requests, Prefer.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace tunewright::server::http {

/// The text with the letters A to Z in lower case, independent of the locale.
std::string lower_case(std::string_view text);

/// All fields of that name, combined into one list (RFC 9110, section 5.3).
std::string list_of(const Request& request, std::string_view name);

/// The client's preference for `type` ("application/json"), 0 (none) to 1, by the narrowest matching range of Accept
/// (RFC 9110, section 12.5.1); 1 without Accept.
double preference(const Request& request, std::string_view type);

/// True if preference() is above 0.
bool accepts(const Request& request, std::string_view type);

/// The quality of `name`, or else of `*`, in a list such as that of Accept-Encoding: 0 (not wanted) to 1; empty if the
/// list has neither. A weight that is not valid counts as 0.
std::optional<double> quality(std::string_view list, std::string_view name);

/// The media type of the body, in lower case and without its parameters; "" if the head has none.
std::string media_type(const Request& request);

/// True for a body that may be JSON: application/json, anything ending in +json, no type at all, and
/// application/x-www-form-urlencoded, which `curl -d` sends for every body.
bool sends_json(const Request& request);

/// `wait` of RFC 7240, at most 60 s; empty if it is missing or not a whole number.
std::optional<std::chrono::seconds> preferred_wait(const Request& request);

/// A checksum of the bytes that is the same in every process, as 16 hexadecimal digits (FNV-1a, 64 bits).
std::string text_sum(std::string_view text);

/// A strong entity tag of the bytes, with its quotes: their checksum.
std::string entity_tag(std::string_view body);

/// False if the request has If-Match and none of its tags is this one, weak or strong: a compressed answer has the weak
/// one.
bool matches_entity_tag(const Request& request, const std::string& tag);

/// Sets ETag, and turns the answer into 304 if the request already has that tag, weak or strong.
void apply_entity_tag(const Request& request, Response& response, const std::string& tag);

}  // namespace tunewright::server::http
