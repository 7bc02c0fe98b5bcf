// The addresses that the service may call: only those below the operator's targets. A URL is parsed strictly, so that
// no program finds another host or path in it than those compared here.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tunewright::server {

struct WebAddress {
    bool tls = true;
    std::string host;  ///< lower case; an IPv6 address without brackets, in the notation of inet_ntop()
    int port = 443;
    std::string path = "/";  ///< as sent, including percent codes
    std::string query;       ///< with its question mark; "" if none

    /// "https://hooks.example.com", with the port if it is not the default: the only part of a URL that a log shows.
    std::string origin() const;
    /// The host and, if it is not the default, the port: the field Host.
    std::string authority() const;
    /// The target of an HTTP request.
    std::string target() const { return path + query; }
};

/// Parses a URL: the address, or the fault and its cure as the end of a sentence that begins with the URL. Refused are
/// a user, a fragment, blanks, backslashes and characters beyond ASCII, segments of dots in any spelling, and empty
/// segments except the last.
std::variant<WebAddress, std::string> parse_address(std::string_view url);

class Targets {
public:
    /// `allowed`: https://hooks.example.com, optionally with a port and the beginning of a path; http:// only if it is
    /// given. Throws std::invalid_argument with a sentence for anything else.
    explicit Targets(const std::vector<std::string>& allowed);

    bool empty() const { return allowed_.empty(); }
    /// True if scheme, host and port are equal, and the path begins with the allowed one, up to the end of a segment.
    bool allow(const WebAddress& address) const;

private:
    std::vector<WebAddress> allowed_;
};

}  // namespace tunewright::server
