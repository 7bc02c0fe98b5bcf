#include "server/commands.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "server/config.h"
#include "server/http/problems.h"
#include "server/jobs/timer.h"

namespace tunewright::server {
namespace {

/// All of the file, or of standard input for "-". Returns false where it cannot be read.
bool read_input(const std::string& file, std::string& text) {
    if (file == "-") {
        text.assign(std::istreambuf_iterator<char>(std::cin), {});
        return true;
    }
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) return false;
    const std::streamoff size = stream.tellg();
    if (size < 0) {  // a pipe has no size
        stream.clear();
        text.assign(std::istreambuf_iterator<char>(stream), {});
        return !stream.bad();
    }
    text.resize(static_cast<std::size_t>(size));
    stream.seekg(0);
    stream.read(text.data(), size);
    return static_cast<bool>(stream);
}

api::Problem unreadable(const std::string& file) { return http::problem(404, "The file " + file + " cannot be read."); }

int fail(const std::string& problem_json) {
    std::cerr << problem_json << "\n";
    return 1;
}

int fail(const api::Problem& problem) { return fail(api::to_json(problem)); }

double monotonic_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// A request is one JSON object; a log may have one in each line.
bool is_request(const std::string& text) {
    constexpr const char* kBlank = " \t\r\n";
    const std::size_t first = text.find_first_not_of(kBlank);
    if (first == std::string::npos || text[first] != '{') return false;
    const std::size_t end = text.find('\n', first);
    if (end == std::string::npos) return true;
    const std::size_t last = text.find_last_not_of(kBlank, end), next = text.find_first_not_of(kBlank, end);
    return !(text[last] == '}' && next != std::string::npos && text[next] == '{');
}

}  // namespace

int tune(const std::string& file) {
    std::string text;
    if (!read_input(file, text)) return fail(unreadable(file));
    const auto prepared = api::prepare_job(text);
    if (const auto* problem = std::get_if<api::Problem>(&prepared)) return fail(*problem);
    const auto& job = std::get<api::PreparedJob>(prepared);

    std::stop_source stop;
    Timer timer;
    timer.after(std::chrono::duration<double>(job.timeout_s), [&stop] { stop.request_stop(); });
    RunControl control;
    control.stop = stop.get_token();
    control.now_ms = monotonic_ms;
    const api::JobOutcome outcome = api::run_job(job, control);
    timer.stop();
    if (outcome.status == api::JobOutcome::Status::succeeded) {
        std::cout << outcome.result_json << "\n";
        return 0;
    }
    if (!outcome.error_json.empty()) return fail(outcome.error_json);
    Error error;
    error.kind = ErrorKind::timeout;
    error.where = "timeout_s";
    error.message = "The computation was stopped after timeout_s. Ask for less, or raise timeout_s.";
    return fail(api::to_problem(error));
}

int identify(const IdentifyCommand& command) {
    std::string text;
    if (!read_input(command.file, text)) return fail(unreadable(command.file));
    const api::Answer answer =
        is_request(text) ? api::identify_call(text, {}) : api::identify_csv(std::move(text), command.question, {});
    const bool failed = answer.status >= 400;
    (failed ? std::cerr : std::cout) << answer.body << "\n";
    return failed ? 1 : 0;
}

namespace {

constexpr timeval kPatience{3, 0};

struct Socket {
    explicit Socket(int number) : fd(number) {}
    ~Socket() {
        if (fd >= 0) ::close(fd);
    }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;
    int fd;
};

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

/// Connected to the first address of the name that answers. Throws std::runtime_error.
std::unique_ptr<Socket> connect(const HostPort& address) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (const int error = ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
        error != 0)
        throw std::runtime_error(::gai_strerror(error));
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> list(found, ::freeaddrinfo);
    for (const addrinfo* at = list.get(); at != nullptr; at = at->ai_next) {
        auto socket = std::make_unique<Socket>(::socket(at->ai_family, at->ai_socktype | SOCK_CLOEXEC, 0));
        // Limits connecting, sending and each wait for bytes.
        ::setsockopt(socket->fd, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
        ::setsockopt(socket->fd, SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
        if (::connect(socket->fd, at->ai_addr, at->ai_addrlen) == 0) return socket;
    }
    throw std::runtime_error(std::strerror(errno));
}

/// The first line of the answer to a GET. Throws std::runtime_error.
std::string status_line(const Target& target) {
    const std::unique_ptr<Socket> socket = connect(target.address);
    const std::string request =
        "GET " + target.path + " HTTP/1.1\r\nHost: " + target.address.host + "\r\nConnection: close\r\n\r\n";
    if (::send(socket->fd, request.data(), request.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request.size()))
        throw std::runtime_error("the request could not be sent");
    std::string line;
    std::array<char, 512> piece{};
    while (line.find("\r\n") == std::string::npos && line.size() < piece.size()) {
        const ssize_t n = ::recv(socket->fd, piece.data(), piece.size(), 0);
        if (n <= 0) throw std::runtime_error("no answer");
        line.append(piece.data(), static_cast<std::size_t>(n));
    }
    return line.substr(0, line.find("\r\n"));
}

int failed(int code, const std::string& url, const std::string& why) {
    std::cerr << "tunewright: " << url << ": " << why << "\n";
    return code;
}

}  // namespace

int check_health(const std::string& url) {
    try {
        const std::string line = status_line(parse_url(url));
        return line.starts_with("HTTP/1.1 200 ") ? 0 : failed(1, url, line);
    } catch (const std::invalid_argument& error) {
        return failed(2, url, error.what());
    } catch (const std::runtime_error& error) {
        return failed(1, url, error.what());
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
