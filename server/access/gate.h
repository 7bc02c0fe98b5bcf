// Asked about every request before any route sees it: who calls, whether he may, and how often.
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
    std::string keys_file;  ///< "": no keys are asked for
    double rate = 0;        ///< calls a second of one client; 0: no limit
    double burst = 0;       ///< at once, after a pause
    SiteSettings sites;
    bool behind_proxy = false;  ///< the client is the last address of X-Forwarded-For, which the proxy has added
    bool own_machine = false;   ///< only this machine can call: without keys whoever does runs the service
};

class Gate {
public:
    /// Throws std::invalid_argument with a sentence.
    explicit Gate(const GateSettings& settings);

    /// Fills in client, owner, request_id and answer_headers. The refusal where he may not: 401 without a known key
    /// (below /v1, and /metrics), 421 for a Host that is not ours, 403 for another site's page, 429 beyond the rate. A
    /// preflight of an allowed site is answered here too.
    std::optional<http::Response> admit(http::Request& request);

    /// Fills in client, request_id and answer_headers of a request that was refused before it came here.
    void name_refused(http::Request& request);

    /// Whether the file of keys can be used; true where no keys are asked for.
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
    std::string process_;  ///< begins the ids of requests, so that those of several processes differ
    std::atomic<std::uint64_t> count_ = 0;
};

}  // namespace tunewright::server
