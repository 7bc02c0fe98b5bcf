// Which addresses the service may be made to call: those below what the operator has written down, and no others. A url
// is taken apart strictly, so that nobody reads another host or another path in it than is compared here.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tunewright::server {

struct WebAddress {
    bool tls = true;
    std::string host;  ///< lower case; an IPv6 address without brackets, as inet_ntop() writes it
    int port = 443;
    std::string path = "/";  ///< as sent, percent codes included
    std::string query;       ///< with its question mark; "" if none

    /// "https://hooks.example.com", with the port where it is not the scheme's own: all that a log shows of a url.
    std::string origin() const;
    /// The host and, where it is not the scheme's own, the port: the field Host.
    std::string authority() const;
    /// What a request asks for.
    std::string target() const { return path + query; }
};

/// The address, or what is wrong with it and what would be right, as the end of a sentence that begins with the url. No
/// user, no fragment, no blank, backslash or character beyond ASCII, no dots as a segment of the path however they are
/// spelled, no empty segment but the last.
std::variant<WebAddress, std::string> parse_address(std::string_view url);

class Targets {
public:
    /// What the operator allows: https://hooks.example.com, with a port and the beginning of a path where that is
    /// wanted; http:// only where it says so. Throws std::invalid_argument with a sentence for anything else.
    explicit Targets(const std::vector<std::string>& allowed);

    bool empty() const { return allowed_.empty(); }
    /// Same scheme, host and port, and the same beginning of the path, up to the end of a segment.
    bool allow(const WebAddress& address) const;

private:
    std::vector<WebAddress> allowed_;
};

}  // namespace tunewright::server
