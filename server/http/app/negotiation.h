// What a request says about forms and preferences: media types, conditional requests, Prefer.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace tunewright::server::http {

/// The text with the letters A to Z in lower case, whatever the locale.
std::string lower_case(std::string_view text);

/// All fields of that name as the one list that they stand for (RFC 9110, section 5.3).
std::string list_of(const Request& request, std::string_view name);

/// How much the client wants `type` ("application/json"), 0 (not) to 1, by the narrowest range of Accept that it lies
/// in (RFC 9110, section 12.5.1); 1 without Accept.
double preference(const Request& request, std::string_view type);

/// True where that is more than 0.
bool accepts(const Request& request, std::string_view type);

/// What a list such as that of Accept-Encoding says about `name`, or else about `*`: 0 (not wanted) to 1; nothing where
/// it says neither. A weight that is not one counts as 0.
std::optional<double> quality(std::string_view list, std::string_view name);

/// The media type of the body, in lower case and without its parameters; "" where the head names none.
std::string media_type(const Request& request);

/// True for a body that may be JSON: application/json, anything ending in +json, no type at all, and
/// application/x-www-form-urlencoded, which is what `curl -d` claims about every body.
bool sends_json(const Request& request);

/// `wait` of RFC 7240, at most 60 s; nothing where it is absent or not a whole number.
std::optional<std::chrono::seconds> preferred_wait(const Request& request);

/// A sum of the bytes that is the same in every process, as 16 hexadecimal digits (FNV-1a, 64 bits).
std::string text_sum(std::string_view text);

/// A strong entity tag of the bytes, with its quotes: their sum.
std::string entity_tag(std::string_view body);

/// False where the request has If-Match and none of its tags is this one, weak or strong: a compressed answer has the
/// weak one.
bool matches_entity_tag(const Request& request, const std::string& tag);

/// Sets ETag, and turns the answer into 304 where the request has that tag already, as a weak or a strong one.
void apply_entity_tag(const Request& request, Response& response, const std::string& tag);

}  // namespace tunewright::server::http
