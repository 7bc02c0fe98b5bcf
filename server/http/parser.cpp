#include "server/http/parser.h"

#include <fcntl.h>
#include <httplib.h>

#include <cstring>
#include <stdexcept>

namespace tunewright::server::http {
namespace {

constexpr int kBacklog = 1024;

/// A stream over bytes that are already here. What the library wants to send is dropped: answers are ours.
class MemoryStream : public httplib::Stream {
public:
    explicit MemoryStream(std::string_view text) : rest_(text) {}

    bool is_readable() const override { return !rest_.empty(); }
    bool is_writable() const override { return true; }
    ssize_t read(char* to, size_t size) override {
        // The library reads byte by byte.
        if (size == 1 && !rest_.empty()) {
            *to = rest_.front();
            rest_.remove_prefix(1);
            return 1;
        }
        const size_t n = std::min(size, rest_.size());
        std::memcpy(to, rest_.data(), n);
        rest_.remove_prefix(n);
        return static_cast<ssize_t>(n);
    }
    ssize_t write(const char*, size_t size) override { return static_cast<ssize_t>(size); }
    void get_remote_ip_and_port(std::string&, int&) const override {}
    void get_local_ip_and_port(std::string&, int&) const override {}
    socket_t socket() const override { return INVALID_SOCKET; }

private:
    std::string_view rest_;
};

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string percent_decode(std::string_view text) {
    std::string out;
    for (size_t i = 0; i < text.size(); i++) {
        const bool coded =
            text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0;
        out.push_back(coded ? static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2])) : text[i]);
        if (coded) i += 2;
    }
    return out;
}

/// "/v1/jobs" -> {"v1", "jobs"}; "/" -> {}; "/v1/" -> {"v1", ""}.
std::vector<std::string> split_path(std::string_view path) {
    std::vector<std::string> segments;
    if (path.size() <= 1) return segments;
    path.remove_prefix(1);
    for (;;) {
        const size_t slash = path.find('/');
        segments.push_back(percent_decode(path.substr(0, slash)));
        if (slash == std::string_view::npos) return segments;
        path.remove_prefix(slash + 1);
    }
}

/// The fields of a head that has passed read_head, as they were sent. The library decodes percent signs in values,
/// after they were checked: what it makes of them is not used.
void add_fields(std::string_view head, Request& request) {
    head.remove_prefix(head.find("\r\n") + 2);  // the request line
    while (!head.empty() && !head.starts_with("\r\n")) {
        const std::string_view line = head.substr(0, head.find("\r\n"));
        head.remove_prefix(line.size() + 2);
        const std::size_t colon = line.find(':');
        const std::size_t first = line.find_first_not_of(" \t", colon + 1);
        const std::size_t last = line.find_last_not_of(" \t");
        request.headers.emplace(line.substr(0, colon),
                                first == std::string_view::npos ? "" : line.substr(first, last - first + 1));
    }
}

}  // namespace

class Parser::Front : public httplib::Server {
public:
    Front() {
        set_tcp_nodelay(true);
        set_socket_options([](socket_t fd) {
            const int on = 1;
            ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        });
        set_pre_routing_handler([](const httplib::Request&, httplib::Response& response) {
            response.status = 204;
            return HandlerResponse::Handled;
        });
    }

    int open(const std::string& host, int port) {
        errno = 0;
        if (!bind_to_port(host, port)) {
            const std::string where = host + ":" + std::to_string(port);
            if (errno == EADDRINUSE)
                throw std::runtime_error("Cannot listen on " + where +
                                         ": the port is taken by another process. Stop it or choose another --listen.");
            throw std::runtime_error("Cannot listen on " + where + ": " +
                                     (errno != 0 ? std::strerror(errno) : "the host name is not known") + ".");
        }
        // The library listens with a backlog of 5, which drops connections of any burst.
        ::listen(svr_sock_, kBacklog);
        ::fcntl(svr_sock_, F_SETFL, ::fcntl(svr_sock_, F_GETFL) | O_NONBLOCK);
        return svr_sock_;
    }

    void shut() {
        if (svr_sock_ != INVALID_SOCKET) ::close(svr_sock_.exchange(INVALID_SOCKET));
    }

    std::optional<Request> parse(std::string_view head) {
        MemoryStream stream(head);
        std::optional<Request> parsed;
        bool closed = false;
        // "Close" makes the least of the answer that the library insists on writing, and that is dropped.
        process_request(stream, true, closed, [&](httplib::Request& raw) {
            parsed.emplace();
            parsed->method = std::move(raw.method);
            parsed->target = std::move(raw.target);
            for (auto& [name, value] : raw.params) parsed->query.emplace(name, std::move(value));
            parsed->segments = split_path(parsed->path());
        });
        if (parsed) add_fields(head, *parsed);
        return parsed;
    }
};

Parser::Parser() : front_(std::make_unique<Front>()) {}

Parser::~Parser() { front_->shut(); }

void Parser::stop_listening() { front_->shut(); }

int Parser::listen(const std::string& host, int port) { return front_->open(host, port); }

std::optional<Request> Parser::parse(std::string_view head) { return front_->parse(head); }

}  // namespace tunewright::server::http
