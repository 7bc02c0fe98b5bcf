#include "server/notify/sender.h"

#include <fcntl.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>

namespace tunewright::server {
namespace {

constexpr std::size_t kMaxReadBytes = 64 * 1024;  ///< of an answer's body, which is ignored

std::unique_ptr<httplib::ClientImpl> client_for(const WebAddress& address) {
    if (!address.tls) return std::make_unique<httplib::ClientImpl>(address.host, address.port);
    auto made = std::make_unique<httplib::SSLClient>(address.host, address.port);
    made->enable_server_certificate_verification(true);
    return made;
}

std::string fault_of(httplib::Error error) {
    switch (error) {
        case httplib::Error::Connection: return "it cannot be reached";
        case httplib::Error::ConnectionTimeout: return "it cannot be reached within 5 s";
        case httplib::Error::SSLConnection: return "it has no suitable version of TLS";
        case httplib::Error::SSLLoadingCerts: return "this machine has no CA certificates to verify it";
        case httplib::Error::SSLServerVerification: return "this machine does not trust its certificate";
        case httplib::Error::Read: return "it did not answer in time, or not completely";
        case httplib::Error::Write: return "it did not accept the notification";
        default: return "the exchange failed (" + httplib::to_string(error) + ")";
    }
}

}  // namespace

Sender::~Sender() {
    for (const int socket : sockets_) ::close(socket);
}

void Sender::opened(int socket) {
    const int kept = ::fcntl(socket, F_DUPFD_CLOEXEC, 0);
    if (kept < 0) return;
    const std::lock_guard lock(mutex_);
    sockets_.push_back(kept);
    if (cut_) ::shutdown(kept, SHUT_RDWR);
}

void Sender::cut() {
    const std::lock_guard lock(mutex_);
    cut_ = true;
    for (const int socket : sockets_) ::shutdown(socket, SHUT_RDWR);
}

Reply Sender::send(const OutgoingNote& note) {
    const auto client = client_for(note.address);
    if (!client->is_valid()) return {0, fault_of(httplib::Error::SSLLoadingCerts), {}};
    client->set_connection_timeout(kConnect);
    client->set_read_timeout(kReadWrite);
    client->set_write_timeout(kReadWrite);
    client->set_follow_location(false);
    client->set_keep_alive(false);
    client->set_tcp_nodelay(true);
    client->set_url_encode(false);
    client->set_socket_options([this](socket_t socket) { opened(socket); });

    httplib::Request request;
    request.method = "POST";
    request.path = note.address.target();
    request.body = note.body;
    request.set_header("Host", note.address.authority());
    for (const auto& [name, value] : note.headers) request.set_header(name, value);
    Reply reply;
    std::size_t read = 0;
    request.response_handler = [&](const httplib::Response& head) {
        reply.status = head.status;
        reply.retry_after = head.get_header_value("Retry-After");
        return true;
    };
    request.content_receiver = [&](const char*, std::size_t length, std::uint64_t, std::uint64_t) {
        read += length;
        return read <= kMaxReadBytes;
    };
    httplib::Response response;
    httplib::Error error = httplib::Error::Success;
    const bool done = client->send(request, response, error);
    // Once the head has arrived the answer is known, even if its body fails.
    if (reply.status == 0) {
        if (done)
            reply.status = response.status;
        else
            reply.fault = fault_of(error);
    }
    return reply;
}

}  // namespace tunewright::server
