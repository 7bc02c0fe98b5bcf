#include "server/access/sites.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "server/http/app/negotiation.h"

namespace tunewright::server {
namespace {

/// The host of HOST, HOST:PORT, [V6] or [V6]:PORT, in lower case and without a final dot.
std::string host_of(std::string_view authority) {
    if (authority.starts_with('[')) {
        const std::size_t end = authority.find(']');
        return end == std::string_view::npos ? std::string{} : http::lower_case(authority.substr(1, end - 1));
    }
    std::string host = http::lower_case(authority.substr(0, authority.find(':')));
    if (host.ends_with('.')) host.pop_back();
    return host;
}

bool is_address(const std::string& host) {
    std::array<unsigned char, sizeof(in6_addr)> bytes{};
    return ::inet_pton(AF_INET, host.c_str(), bytes.data()) == 1 ||
           ::inet_pton(AF_INET6, host.c_str(), bytes.data()) == 1;
}

/// HOST[:PORT] of SCHEME://HOST[:PORT]; "" for anything else, such as "null".
std::string_view authority_of(std::string_view origin) {
    const std::size_t colon = origin.find("://");
    return colon == std::string_view::npos ? std::string_view{} : origin.substr(colon + 3);
}

}  // namespace

bool is_loopback(const std::string& host) {
    return host == "localhost" || host.ends_with(".localhost") || host == "::1" ||
           (host.starts_with("127.") && is_address(host));
}

Sites::Sites(SiteSettings settings) : settings_(std::move(settings)) {
    for (const std::string& origin : settings_.cors_origins)
        if (origin != "*" && (authority_of(origin).empty() || origin.ends_with('/')))
            throw std::invalid_argument("--cors-origin is \"" + origin +
                                        "\"; it must be SCHEME://HOST[:PORT] without a slash at the end, or *.");
    for (std::string& host : settings_.allowed_hosts) {
        if (host.empty() || host.find_first_of("/@ ") != std::string::npos)
            throw std::invalid_argument("--allowed-host is \"" + host +
                                        "\"; it must be a name or an address, such as plant.example, or *.");
        host = host_of(host);
    }
    settings_.listen_host = http::lower_case(settings_.listen_host);
    every_address_ = settings_.listen_host == "0.0.0.0" || settings_.listen_host == "::";
}

bool Sites::serves(std::string_view field) const {
    const std::string host = host_of(field);
    if (is_loopback(host) || host == settings_.listen_host || (every_address_ && is_address(host))) return true;
    return std::ranges::any_of(settings_.allowed_hosts,
                               [&](const std::string& allowed) { return allowed == "*" || allowed == host; });
}

bool Sites::is_allowed_site(std::string_view origin) const {
    return std::ranges::any_of(settings_.cors_origins,
                               [&](const std::string& allowed) { return allowed == "*" || allowed == origin; });
}

bool Sites::may_call(std::string_view origin, std::string_view host) const {
    if (is_allowed_site(origin)) return true;
    const std::string_view authority = authority_of(origin);
    if (authority.empty()) return false;
    // Behind a proxy the service sees plain HTTP, and a Host without its port or one that the proxy has set.
    const bool same = settings_.behind_proxy ? host_of(authority) == host_of(host)
                                             : http::lower_case(authority) == http::lower_case(host);
    return same || std::ranges::count(settings_.allowed_hosts, host_of(authority)) > 0;
}

}  // namespace tunewright::server
