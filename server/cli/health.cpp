// `tunewright health`, for health checks where there is no curl.
#include <httplib.h>

#include <algorithm>
#include <iostream>
#include <stdexcept>
#include <string>

#include "server/cli/commands.h"
#include "server/config.h"

namespace tunewright::server {
namespace {

constexpr int kPatienceSeconds = 3;

struct Target {
    HostPort address;
    std::string path = "/";
};

Target parse_url(const std::string& url) {
    constexpr std::string_view scheme = "http://";
    const char* const rule = "it must be http://HOST:PORT/PATH.";
    if (!url.starts_with(scheme)) throw std::invalid_argument(rule);
    const std::size_t slash = std::min(url.find('/', scheme.size()), url.size());
    Target target;
    try {
        target.address = parse_listen(url.substr(scheme.size(), slash - scheme.size()));
    } catch (const std::invalid_argument&) {
        throw std::invalid_argument(rule);
    }
    if (slash < url.size()) target.path = url.substr(slash);
    return target;
}

int failed(int code, const std::string& url, const std::string& why) {
    std::cerr << "tunewright: " << url << ": " << why << "\n";
    return code;
}

}  // namespace

int check_health(const std::string& url) {
    try {
        const Target target = parse_url(url);
        httplib::Client client(target.address.host, target.address.port);
        client.set_connection_timeout(kPatienceSeconds);
        client.set_read_timeout(kPatienceSeconds);
        const httplib::Result answer = client.Get(target.path);
        if (!answer) return failed(1, url, "nothing answers there (" + httplib::to_string(answer.error()) + ")");
        return answer->status == 200 ? 0 : failed(1, url, "it answers " + std::to_string(answer->status));
    } catch (const std::invalid_argument& error) {
        return failed(2, url, error.what());
    }
}

std::string health_url(const std::string& listen) {
    HostPort address = parse_listen(listen);
    if (address.host == "0.0.0.0") address.host = "127.0.0.1";
    if (address.host == "::") address.host = "::1";
    const bool v6 = address.host.find(':') != std::string::npos;
    return "http://" + (v6 ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port) + "/healthz";
}

}  // namespace tunewright::server
