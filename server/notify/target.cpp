#include "server/notify/target.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

namespace tunewright::server {
namespace {

constexpr std::size_t kMaxHost = 253, kMaxLabel = 63;
constexpr std::string_view kRule = "it must be like https://hooks.example.com/path";

using Fault = std::optional<std::string>;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool is_name_character(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == '-' || c == '_' || c == '.';
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    c = lower(c);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/// Checks the characters of a URL: those that some programs correct, and so read differently, are refused.
Fault check_characters(std::string_view url) {
    constexpr std::string_view refused = "\\\"<>^`{|}";
    for (const char c : url) {
        if (c <= 0x20 || c >= 0x7F) return "it must be ASCII without blanks; other characters are written as % codes";
        if (c == '#') return "it must have no fragment: leave out # and what follows";
        if (refused.find(c) != std::string_view::npos)
            return std::string("it must not contain ") + c + "; such a character is written as a % code";
    }
    return std::nullopt;
}

/// True if the decoded segment is . or .., also before a ; because some servers end the name there.
bool is_dots(std::string_view segment) {
    segment = segment.substr(0, segment.find(';'));
    return segment == "." || segment == "..";
}

Fault check_path(std::string_view path) {
    std::string segment;
    for (std::size_t i = 1; i <= path.size(); i++) {
        if (i == path.size() || path[i] == '/') {
            if (is_dots(segment)) return "its path must have no segment . or ..";
            if (segment.empty() && i < path.size()) return "its path must have no empty segment, such as in //";
            segment.clear();
            continue;
        }
        if (path[i] != '%') {
            segment += path[i];
            continue;
        }
        const int high = i + 2 < path.size() ? hex_digit(path[i + 1]) : -1;
        const int low = high >= 0 ? hex_digit(path[i + 2]) : -1;
        if (low < 0) return "each % in it must be followed by two hexadecimal digits";
        const int code = 16 * high + low;
        // If one program decodes these and the next does not, the path leads elsewhere.
        if (code < 0x20 || code == 0x7F || code == '/' || code == '\\' || code == '%')
            return "its path must not contain / \\ % or control characters as % codes";
        segment += static_cast<char>(code);
        i += 2;
    }
    return std::nullopt;
}

Fault read_name(std::string_view host, std::string& name) {
    name.assign(host);
    std::ranges::transform(name, name.begin(), lower);
    if (name.empty() || name.size() > kMaxHost || !std::ranges::all_of(name, is_name_character))
        return "its host must be a name or an address: letters, digits, hyphens and dots";
    for (std::size_t from = 0; from <= name.size();) {
        const std::size_t dot = std::min(name.find('.', from), name.size());
        if (dot == from || dot - from > kMaxLabel) return "its host must have 1 to 63 characters between dots";
        from = dot + 1;
    }
    return std::nullopt;
}

Fault read_ipv6(std::string_view text, std::string& host) {
    in6_addr address{};
    std::array<char, INET6_ADDRSTRLEN> spelled{};
    if (::inet_pton(AF_INET6, std::string(text).c_str(), &address) != 1)
        return "between its brackets must be an IPv6 address";
    ::inet_ntop(AF_INET6, &address, spelled.data(), spelled.size());
    host = spelled.data();
    return std::nullopt;
}

Fault read_port(std::string_view text, int& port) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
    const bool whole = error == std::errc{} && end == text.data() + text.size() && text.front() != '0';
    if (!whole || text.size() > 5 || port < 1 || port > 65535) return "its port must be a number from 1 to 65535";
    return std::nullopt;
}

Fault read_authority(std::string_view text, WebAddress& address) {
    if (text.find('@') != std::string_view::npos)
        return "it must have no user before an @: secrets belong in the path or the query";
    if (text.starts_with('[')) {
        const std::size_t close = text.find(']');
        if (close == std::string_view::npos) return "the bracket of its IPv6 address must be closed";
        if (auto fault = read_ipv6(text.substr(1, close - 1), address.host)) return fault;
        text.remove_prefix(close + 1);
    } else {
        const std::size_t colon = std::min(text.find(':'), text.size());
        if (auto fault = read_name(text.substr(0, colon), address.host)) return fault;
        text.remove_prefix(colon);
    }
    if (text.empty()) return std::nullopt;
    if (text.front() != ':' || text.size() == 1) return std::string(kRule);
    return read_port(text.substr(1), address.port);
}

}  // namespace

std::string WebAddress::authority() const {
    const std::string name = host.find(':') == std::string::npos ? host : "[" + host + "]";
    return port == (tls ? 443 : 80) ? name : name + ":" + std::to_string(port);
}

std::string WebAddress::origin() const { return (tls ? "https://" : "http://") + authority(); }

std::variant<WebAddress, std::string> parse_address(std::string_view url) {
    if (auto fault = check_characters(url)) return *std::move(fault);
    const std::size_t colon = url.find("://");
    if (colon == std::string_view::npos) return std::string(kRule);
    std::string scheme(url.substr(0, colon));
    std::ranges::transform(scheme, scheme.begin(), lower);
    if (scheme != "https" && scheme != "http") return "its scheme must be https";
    WebAddress address;
    address.tls = scheme == "https";
    address.port = address.tls ? 443 : 80;
    url.remove_prefix(colon + 3);
    const std::size_t end = std::min(url.find_first_of("/?"), url.size());
    if (auto fault = read_authority(url.substr(0, end), address)) return *std::move(fault);
    url.remove_prefix(end);
    const std::size_t question = std::min(url.find('?'), url.size());
    if (question > 0) address.path.assign(url.substr(0, question));
    address.query.assign(url.substr(question));
    if (auto fault = check_path(address.path)) return *std::move(fault);
    return address;
}

Targets::Targets(const std::vector<std::string>& allowed) {
    for (const std::string& text : allowed) {
        auto read = parse_address(text);
        if (const auto* fault = std::get_if<std::string>(&read))
            throw std::invalid_argument("--notify-target is \"" + text + "\"; " + *fault + ".");
        allowed_.push_back(std::get<WebAddress>(std::move(read)));
        if (!allowed_.back().query.empty())
            throw std::invalid_argument("--notify-target is \"" + text +
                                        "\"; it must end with the path: leave out ? and what follows.");
    }
}

bool Targets::allow(const WebAddress& address) const {
    return std::ranges::any_of(allowed_, [&](const WebAddress& one) {
        if (one.tls != address.tls || one.host != address.host || one.port != address.port) return false;
        if (!address.path.starts_with(one.path)) return false;
        return one.path.ends_with('/') || address.path.size() == one.path.size() ||
               address.path[one.path.size()] == '/';
    });
}

}  // namespace tunewright::server
