// What the process is told at its start.
#pragma once

#include <string>

namespace tunewright::server {

struct Config {
    std::string listen = "127.0.0.1:8080";  ///< HOST:PORT; [::1]:8080 for IPv6; port 0: the system chooses
    std::string store = "sqlite:tunewright.db";
    std::size_t workers = 0;  ///< 0: as many as there are cores
    std::size_t queue_limit = 10'000;
    std::size_t body_limit_mib = 8;    ///< of one request
    std::string web;                   ///< "": `web` beside the folder of the binary
    std::string log_format = "plain";  ///< or json
    std::string log_level = "info";    ///< debug, info, warn, error
    double grace_s = 5;                ///< what running jobs get when the service is asked to stop
};

struct HostPort {
    std::string host;
    int port = 0;
};

/// Throws std::invalid_argument with a sentence.
HostPort parse_listen(const std::string& text);

/// The path of "sqlite:PATH". Throws std::invalid_argument with a sentence.
std::string parse_store(const std::string& text);

/// build/release/tunewright -> build/web
std::string default_web_folder();

std::size_t core_count();

}  // namespace tunewright::server
