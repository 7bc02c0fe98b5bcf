#include "server/config.h"

#include <charconv>
#include <filesystem>
#include <stdexcept>
#include <thread>

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

std::string parse_store(const std::string& text) {
    constexpr std::string_view prefix = "sqlite:";
    if (!text.starts_with(prefix) || text.size() == prefix.size())
        throw std::invalid_argument("--store is \"" + text +
                                    "\"; it must be sqlite:PATH, such as sqlite:tunewright.db.");
    return text.substr(prefix.size());
}

std::string default_web_folder() {
    std::error_code error;
    const std::filesystem::path binary = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::string{} : (binary.parent_path().parent_path() / "web").string();
}

std::size_t core_count() { return std::max<std::size_t>(1, std::thread::hardware_concurrency()); }

}  // namespace tunewright::server
