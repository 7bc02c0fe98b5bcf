// Checks every request before its route: identity, permission and rate of the client.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/access/keys.h"
#include "server/access/rate_limit.h"
#include "server/access/sites.h"
#include "server/http/message.h"

namespace tunewright::server {

struct GateSettings {
    std::string keys_file;  ///< "": no keys are required
    double rate = 0;        ///< calls per second of one client; 0: no limit
    double burst = 0;       ///< calls at once, after a pause
    SiteSettings sites;
    bool behind_proxy = false;  ///< the client is the last address of X-Forwarded-For, which the proxy has added
    bool own_machine = false;   ///< only this machine can call: without keys every caller is an administrator
};

class Gate {
public:
    /// Throws std::invalid_argument with a sentence for settings that are not valid.
    explicit Gate(const GateSettings& settings);

    /// Fills in client, owner, request_id and answer_headers. Returns the refusal of a request that is not admitted:
    /// 401 without a known key (below /v1, /mcp and /metrics), 421 for a Host that is not one of the service's names,
    /// 403 for another site's page, 429 beyond the rate. Also answers the preflight of an allowed site.
    std::optional<http::Response> admit(http::Request& request);

    /// Fills in client, request_id and answer_headers of a request that was refused before it reached the gate.
    void name_refused(http::Request& request);

    /// True if the file of keys can be used, or no keys are required.
    bool ready() { return !keys_ || keys_->usable(); }

private:
    void name(http::Request& request);
    std::optional<http::Response> check_host(const http::Request& request) const;
    std::optional<http::Response> check_site(http::Request& request) const;
    bool allow_site(http::Request& request) const;
    std::optional<http::Response> check_key(http::Request& request);
    std::optional<http::Response> check_rate(const http::Request& request);

    GateSettings settings_;
    Sites sites_;
    std::unique_ptr<KeyRing> keys_;
    std::unique_ptr<RateLimit> rate_;
    std::string process_;  ///< prefix of the ids of requests, so that those of several processes differ
    std::atomic<std::uint64_t> count_ = 0;
};

}  // namespace tunewright::server
