#include "server/config.h"

#include <charconv>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace tunewright::server {
namespace {

bool is_loopback(const std::string& host) { return host == "localhost" || host == "::1" || host.starts_with("127."); }

}  // namespace

HostPort parse_listen(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    HostPort result;
    const char* end = text.data() + text.size();
    const bool has_port = colon != std::string::npos && colon + 1 < text.size();
    const auto [stop, error] = has_port ? std::from_chars(text.data() + colon + 1, end, result.port)
                                        : std::from_chars_result{end, std::errc::invalid_argument};
    if (error != std::errc{} || stop != end || result.port < 0 || result.port > 65535)
        throw std::invalid_argument("--listen is \"" + text + "\"; it must be HOST:PORT, such as 127.0.0.1:8080.");
    result.host = text.substr(0, colon);
    if (result.host.size() > 2 && result.host.front() == '[' && result.host.back() == ']')
        result.host = result.host.substr(1, result.host.size() - 2);
    if (result.host.empty()) result.host = "0.0.0.0";
    return result;
}

Role parse_role(const std::string& text) {
    if (text == "all") return Role::all;
    if (text == "api") return Role::api;
    if (text == "worker") return Role::worker;
    throw std::invalid_argument("--role is \"" + text + "\"; it must be all, api or worker.");
}

std::string parse_store(const std::string& text) {
    constexpr std::string_view prefix = "sqlite:";
    if (!text.starts_with(prefix) || text.size() == prefix.size())
        throw std::invalid_argument("--store is \"" + text +
                                    "\"; it must be sqlite:PATH, such as sqlite:tunewright.db.");
    return text.substr(prefix.size());
}

void check_config(const Config& config) {
    const HostPort address = parse_listen(config.listen);
    const bool one_process = config.store.starts_with("sqlite:");
    if (parse_role(config.role) != Role::all && one_process)
        throw std::invalid_argument("--role " + config.role +
                                    " shares its store with other processes, which SQLite cannot: give --store "
                                    "postgresql://..., or --role all.");
    if (config.auth != "none" && config.auth != "keys")
        throw std::invalid_argument("--auth is \"" + config.auth + "\"; it must be none or keys.");
    if (config.auth == "keys" && config.keys.empty())
        throw std::invalid_argument("--auth keys needs --keys FILE; `tunewright key NAME --keys FILE` makes one.");
    if (config.auth == "none" && !config.keys.empty())
        throw std::invalid_argument("--keys is given, but --auth is none: give --auth keys, or leave --keys out.");
    if (config.auth == "none" && !is_loopback(address.host) && !config.allow_anonymous)
        throw std::invalid_argument(
            "--listen " + config.listen +
            " can be reached from other machines, and no keys are asked for. Give --auth keys --keys FILE, or "
            "--allow-anonymous where the network itself keeps strangers out, or listen on 127.0.0.1.");
    if (config.job_timeout_s > config.max_timeout_s)
        throw std::invalid_argument("--job-timeout is longer than --max-timeout.");
}

std::string default_web_folder() {
    std::error_code error;
    const std::filesystem::path binary = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::string{} : (binary.parent_path().parent_path() / "web").string();
}

std::size_t core_count() { return std::max<std::size_t>(1, std::thread::hardware_concurrency()); }

}  // namespace tunewright::server
