// The names and pages from which this service may be called: protection against DNS rebinding and against pages of
// other sites. A page on a name that was rebound to this machine sends that name as Host; a page of another site sends
// its own Origin.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tunewright::server {

struct SiteSettings {
    std::string listen_host = "127.0.0.1";        ///< an address or a name, without brackets
    std::vector<std::string> allowed_hosts = {};  ///< additional names, such as plant.example; "*": every name
    std::vector<std::string> cors_origins = {};   ///< sites whose pages may call: SCHEME://HOST[:PORT]; "*": every site
    bool behind_proxy = false;                    ///< a proxy may have removed the port from Host
};

/// True for a name or an address of this machine only.
bool is_loopback(const std::string& host);

/// Names are compared without regard to letter case. Ports are compared only in origins, and not behind a proxy.
class Sites {
public:
    /// Throws std::invalid_argument with a sentence if an allowed host or an origin is not valid.
    explicit Sites(SiteSettings settings);

    /// True if `host`, the field Host, names this service: the listen address, localhost, a loopback address, an
    /// allowed host; or any address (not a name) if the service listens on all of them, since addresses cannot be
    /// rebound.
    bool serves(std::string_view host) const;

    /// True if a page of `origin` may call the service, reached as `host`: the service's own page, or an allowed site.
    bool may_call(std::string_view origin, std::string_view host) const;

    /// True if `origin` is an allowed site, which gets CORS headers.
    bool is_allowed_site(std::string_view origin) const;

private:
    SiteSettings settings_;
    bool every_address_ = false;
};

}  // namespace tunewright::server
