// From which names and from which pages this service may be called: the fence against DNS rebinding and against other
// sites' pages. A page on a name that was rebound to this machine sends that name as Host; a page of another site sends
// its own Origin.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tunewright::server {

struct SiteSettings {
    std::string listen_host = "127.0.0.1";        ///< an address or a name, without brackets
    std::vector<std::string> allowed_hosts = {};  ///< further names, such as plant.example; "*": every name
    std::vector<std::string> cors_origins = {};   ///< sites whose pages may call: SCHEME://HOST[:PORT]; "*": every site
    bool behind_proxy = false;                    ///< a proxy may have taken the port out of Host
};

/// Whether a name or an address is that of this machine alone.
bool is_loopback(const std::string& host);

/// Names are compared without regard to letter case. Ports count in origins alone, and there not behind a proxy.
class Sites {
public:
    /// Throws std::invalid_argument with a sentence where an allowed host or an origin is none.
    explicit Sites(SiteSettings settings);

    /// Whether `host`, the field Host, names this service: the listen address, localhost, a loopback address, an
    /// allowed host; any address (not a name) where the service listens on every one, since no page can have an address
    /// rebound.
    bool serves(std::string_view host) const;

    /// Whether a page of `origin` may call what it reached as `host`: the service's own page, or an allowed site.
    bool may_call(std::string_view origin, std::string_view host) const;

    /// Whether `origin` is an allowed site, which learns so from CORS headers.
    bool is_allowed_site(std::string_view origin) const;

private:
    SiteSettings settings_;
    bool every_address_ = false;
};

}  // namespace tunewright::server
