#include "server/config.h"

#include <array>
#include <charconv>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "server/access/sites.h"
#include "server/store/open_store.h"

namespace tunewright::server {

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

ProcessRole parse_role(const std::string& text) {
    if (text == "all") return ProcessRole::all;
    if (text == "api") return ProcessRole::api;
    if (text == "worker") return ProcessRole::worker;
    throw std::invalid_argument("--role is \"" + text + "\"; it must be all, api or worker.");
}

namespace {

struct Unit {
    std::string_view name;
    double factor;
};

template <std::size_t N>
double in_units(const std::string& text, const std::array<Unit, N>& units, const std::string& rule) {
    double number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error == std::errc{} && number >= 0 && number < 1e12) {
        const std::string_view unit(stop, static_cast<std::size_t>(end - stop));
        for (const auto& [name, factor] : units)
            if (name == unit) return number * factor;
    }
    throw std::invalid_argument("\"" + text + "\" must be " + rule);
}

}  // namespace

std::size_t parse_size(const std::string& text) {
    constexpr double mib = 1024.0 * 1024.0;
    constexpr double max_plain = 65'536;
    constexpr std::array<Unit, 5> units{{{"", mib}, {"B", 1}, {"KiB", 1024}, {"MiB", mib}, {"GiB", 1024 * mib}}};
    double bytes = in_units(text, units, "a size such as 8 (MiB), 512KiB or 1GiB");
    const bool plain = text.find_first_not_of("0123456789.") == std::string::npos;
    if (plain && bytes > max_plain * mib) bytes /= mib;
    if (bytes < 1024 || bytes > max_plain * mib)
        throw std::invalid_argument("\"" + text + "\" must lie between 1KiB and 64GiB");
    return static_cast<std::size_t>(bytes);
}

double parse_duration(const std::string& text) {
    constexpr std::array<Unit, 7> units{
        {{"", 1}, {"s", 1}, {"ms", 1e-3}, {"m", 60}, {"min", 60}, {"h", 3600}, {"d", 86400}}};
    return in_units(text, units, "a time such as 10 (s), 500ms, 5min, 12h or 7d");
}

void check_config(const Config& config) {
    const HostPort address = parse_listen(config.listen);
    if (!config.metrics_listen.empty()) parse_listen(config.metrics_listen);
    check_store_address(config.store);
    if (parse_role(config.role) != ProcessRole::all && !is_shared_store(config.store))
        throw std::invalid_argument("--role " + config.role +
                                    " shares its store with other processes, which SQLite cannot: give --store "
                                    "postgresql://..., or --role all.");
    if (config.auth != "none" && config.auth != "keys")
        throw std::invalid_argument("--auth is \"" + config.auth + "\"; it must be none or keys.");
    if (config.auth == "keys" && config.keys.empty())
        throw std::invalid_argument("--auth keys needs --keys FILE; `tunewright key NAME --keys FILE` makes one.");
    if (config.migrate != "auto" && config.migrate != "manual")
        throw std::invalid_argument("--migrate is \"" + config.migrate + "\"; it must be auto or manual.");
    if (config.auth == "none" && !config.keys.empty())
        throw std::invalid_argument("--keys is given, but --auth is none: give --auth keys, or leave --keys out.");
    if (config.auth == "none" && !is_loopback(address.host) && !config.allow_anonymous)
        throw std::invalid_argument(
            "--listen " + config.listen +
            " can be reached from other machines, and no keys are required. Give --auth keys --keys FILE, or "
            "--allow-anonymous if the network itself is protected, or listen on 127.0.0.1.");
    if (config.job_timeout_s > config.max_timeout_s)
        throw std::invalid_argument("--job-timeout is longer than --max-timeout.");
}

std::string default_web_folder() {
    std::error_code error;
    const std::filesystem::path binary = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) return {};
    // In the build folder and in the container, or in a package.
    const std::filesystem::path prefix = binary.parent_path().parent_path();
    const std::filesystem::path packaged = prefix / "share" / "tunewright" / "web";
    return (std::filesystem::exists(packaged / "index.html", error) ? packaged : prefix / "web").string();
}

std::size_t core_count() { return std::max<std::size_t>(1, std::thread::hardware_concurrency()); }

}  // namespace tunewright::server
