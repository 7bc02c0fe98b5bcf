#include "server/http/app/negotiation.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <vector>

namespace tunewright::server::http {
namespace {

constexpr std::chrono::seconds kMaxWait{60};

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t at = text.find(separator);
        parts.push_back(trim(text.substr(0, at)));
        if (at == std::string_view::npos) return parts;
        text.remove_prefix(at + 1);
    }
}

/// The weight among the parameters of one item of a list.
double weight(const std::vector<std::string_view>& parts) {
    for (std::size_t i = 1; i < parts.size(); i++) {
        const std::string parameter = lower_case(parts[i]);
        if (!parameter.starts_with("q=")) continue;
        double q = 0;
        const char* const end = parameter.data() + parameter.size();
        const auto [stop, error] = std::from_chars(parameter.data() + 2, end, q, std::chars_format::fixed);
        return error == std::errc{} && stop == end && q >= 0 && q <= 1 ? q : 0;
    }
    return 1;
}

std::string_view without_weakness(std::string_view tag) {
    if (tag.starts_with("W/")) tag.remove_prefix(2);
    return tag;
}

/// The weight that the list gives to the name itself.
std::optional<double> said_of(std::string_view list, std::string_view name) {
    for (const std::string_view item : split(list, ',')) {
        const auto parts = split(item, ';');
        if (lower_case(parts.front()) == name) return weight(parts);
    }
    return std::nullopt;
}

}  // namespace

std::string lower_case(std::string_view text) {
    std::string out(text);
    std::ranges::transform(out, out.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return out;
}

std::string list_of(const Request& request, std::string_view name) {
    std::string list;
    const auto [first, last] = request.headers.equal_range(name);
    for (auto field = first; field != last; ++field) list.append(list.empty() ? "" : ",").append(field->second);
    return list;
}

double preference(const Request& request, std::string_view type) {
    const std::string accept = list_of(request, "Accept");
    if (accept.empty()) return 1;
    const std::string family = std::string(type.substr(0, type.find('/'))) + "/*";
    for (const std::string_view range : {type, std::string_view(family), std::string_view("*/*")})
        if (const auto said = said_of(accept, range)) return *said;
    return 0;
}

bool accepts(const Request& request, std::string_view type) { return preference(request, type) > 0; }

std::optional<double> quality(std::string_view list, std::string_view name) {
    const std::optional<double> said = said_of(list, name);
    return said ? said : said_of(list, "*");
}

std::string media_type(const Request& request) {
    const std::string_view header = request.header("Content-Type");
    return lower_case(trim(header.substr(0, header.find(';'))));
}

bool sends_json(const Request& request) {
    const std::string type = media_type(request);
    return type.empty() || type == "application/json" || type == "application/x-www-form-urlencoded" ||
           type.ends_with("+json");
}

std::optional<std::chrono::seconds> preferred_wait(const Request& request) {
    const auto [first, last] = request.headers.equal_range("Prefer");
    for (auto it = first; it != last; ++it) {
        for (const std::string_view preference : split(it->second, ',')) {
            const std::string_view word = split(preference, ';').front();
            const std::size_t equals = word.find('=');
            if (equals == std::string_view::npos || lower_case(trim(word.substr(0, equals))) != "wait") continue;
            std::string_view digits = trim(word.substr(equals + 1));
            // A quoted value means the same (RFC 7240, section 2).
            if (digits.size() > 2 && digits.front() == '"' && digits.back() == '"')
                digits = digits.substr(1, digits.size() - 2);
            int seconds = 0;
            const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seconds);
            if (error == std::errc::result_out_of_range && digits.front() != '-') return kMaxWait;
            if (error != std::errc{} || end != digits.data() + digits.size() || seconds < 0) continue;
            return std::min(std::chrono::seconds(seconds), kMaxWait);
        }
    }
    return std::nullopt;
}

std::string text_sum(std::string_view text) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const unsigned char c : text) hash = (hash ^ c) * 1099511628211ULL;
    return fmt::format("{:016x}", hash);
}

std::string entity_tag(std::string_view body) { return '"' + text_sum(body) + '"'; }

namespace {

bool lists_tag(const Request& request, std::string_view field, const std::string& tag) {
    const std::string list = list_of(request, field);
    return std::ranges::any_of(split(list, ','), [&](std::string_view candidate) {
        return candidate == "*" || without_weakness(candidate) == without_weakness(tag);
    });
}

}  // namespace

bool matches_entity_tag(const Request& request, const std::string& tag) {
    return !request.has_header("If-Match") || lists_tag(request, "If-Match", tag);
}

void apply_entity_tag(const Request& request, Response& response, const std::string& tag) {
    response.set("ETag", tag);
    const bool known = lists_tag(request, "If-None-Match", tag);
    if (!known) return;
    response.status = 304;
    response.body.clear();
}

}  // namespace tunewright::server::http
