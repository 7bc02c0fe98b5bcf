// What a Server does with one connection: request, answer, next request.
#include <algorithm>
#include <utility>

#include "server/http/server.h"

namespace tunewright::server::http {
namespace {

constexpr std::size_t kSlowestBytesPerMs = 16;

}  // namespace

void Server::pump(Id id) {
    const auto found = connections_.find(id);
    if (found == connections_.end()) return;
    Connection& connection = *found->second;
    switch (connection.state) {
        case Connection::State::reading:
            if (read_step(id, connection)) dispatch(id, connection);
            return;
        case Connection::State::handling:
            if (connection.incoming) body_step(id, connection);
            return;
        case Connection::State::writing: return flush(id, connection);
        case Connection::State::lingering:
            if (!std::exchange(connection.readable, false)) return;
            if (connection.discard() == Io::gone) drop(id);
            return;
    }
}

/// True when a request is ready to be handled.
bool Server::read_step(Id id, Connection& connection) {
    const std::size_t before = connection.buffered();
    Io io = Io::done;
    while (io == Io::done) {
        if (connection.frame().state == Head::State::complete && !connection.admitted()) admit(connection);
        if (connection.frame().state == Head::State::refused || connection.request_ready()) break;
        io = connection.readable ? connection.receive() : Io::again;
    }
    buffered_ += connection.buffered() - before;
    if (io == Io::gone) {
        drop(id);
        return false;
    }
    const Head& head = connection.frame();
    if (head.state == Head::State::refused) {
        refuse(id, connection, head.status, head.detail);
        return false;
    }
    if (connection.request_ready()) return true;
    if (buffered_ > limits_.buffered) {
        refuse(id, connection, 503, "Too many unfinished requests are being received; try again in a moment.");
        return false;
    }
    // The clock of a request runs from its first byte, and once more for its body.
    if (connection.buffered() > 0 && before == 0) enter(connection, Connection::State::reading, limits_.head);
    if (connection.admitted()) {
        connection.deadline = connection.since + limits_.head + limits_.body_time;
        connection.send_continue();
    }
    return false;
}

void Server::admit(Connection& connection) {
    std::optional<Request> request = parser_.parse(connection.frame().clean);
    if (!request) return connection.refuse(400, "The request line or a header field cannot be read.");
    const bool streamed = streams_ && streams_(*request);
    connection.admit(*std::move(request), streamed, streamed ? limits_.max_batch_body : limits_.max_body);
}

void Server::dispatch(Id id, Connection& connection) {
    connection.ticket = next_ticket_++;
    const Mailbox::Address address{id, connection.ticket};
    if (connection.streamed()) {
        const Head& head = connection.frame();
        const BodyDecoder how = head.transfer == Head::Transfer::chunked
                                    ? BodyDecoder::of_chunks(limits_.max_batch_body)
                                    : BodyDecoder::of_length(head.content_length);
        connection.incoming = std::make_shared<IncomingBody>(how, mailbox_, address);
        connection.pace = Pace(limits_.pace_bytes, limits_.pace_time);
    }
    const std::size_t before = connection.buffered();
    Request request = connection.take_request();
    buffered_ -= before - connection.buffered();
    request.source = connection.incoming;
    request.remote_addr = connection.remote_addr();
    enter(connection, Connection::State::handling, limits_.handling);
    const bool is_head = request.method == "HEAD";
    handler_(std::move(request), [mailbox = mailbox_, address, is_head](Response response) {
        response.body_omitted = is_head;
        const std::shared_ptr<BodyStream> stream = response.stream;
        if (!mailbox->put(address, std::move(response))) Outgoing::abandon(stream, false);
    });
}

/// Gives the handler the next piece of the body, if it asks and there is one.
void Server::body_step(Id id, Connection& connection) {
    IncomingBody& body = *connection.incoming;
    if (!body.asked()) return;
    const std::size_t before = connection.buffered();
    std::string piece;
    const Io io = connection.receive_body(piece);
    buffered_ += connection.buffered() - before;
    if (!piece.empty()) {
        connection.pace.arrived(piece.size(), now_);
        enter(connection, Connection::State::handling, limits_.handling);
        return body.give(std::move(piece));
    }
    if (io == Io::gone) return drop(id);
    if (body.decoder.state() == BodyDecoder::State::refused)
        return refuse(id, connection, body.decoder.status(), body.decoder.detail());
    if (body.decoder.state() == BodyDecoder::State::done) {
        enter(connection, Connection::State::handling, limits_.handling);
        return body.finish(BodySource::State::end);
    }
    connection.send_continue();
    connection.pace.wait(now_);
    connection.deadline = connection.pace.end();
}

void Server::refuse(Id id, Connection& connection, int status, const std::string& detail) {
    Response response = refusal_(status, detail, connection.remote_addr());
    response.close = true;
    answer(id, connection, std::move(response));
}

void Server::answer(Id id, Connection& connection, Response response) {
    const bool keep_alive = !response.close && !stopping_;
    const std::chrono::milliseconds for_size(response.body.size() / kSlowestBytesPerMs);
    std::function<void()> wake;
    if (response.stream)
        wake = [mailbox = mailbox_, to = Mailbox::Address{id, connection.ticket}] { mailbox->nudge(to); };
    enter(connection, Connection::State::writing, limits_.writing + for_size);
    connection.start_answer(std::move(response), keep_alive, wake);
    if (connection.incoming) connection.incoming->finish(BodySource::State::refused);
    if (stopping_ && connection.out.endless()) connection.out.end_stream();
    if (connection.peer_closed && connection.out.streams()) return drop(id);
    flush(id, connection);
}

void Server::flush(Id id, Connection& connection) {
    const std::size_t before = connection.out.progress();
    const Io io = connection.send();
    const bool moved = connection.out.progress() != before || connection.deadline == SteadyTime::max();
    switch (io) {
        case Io::done: return after_answer(id, connection);
        case Io::gone: return drop(id);
        case Io::idle: connection.deadline = SteadyTime::max(); return;
        case Io::more: ready_.push_back(id); [[fallthrough]];
        case Io::again:
            if (connection.out.streams() && moved) connection.deadline = now_ + limits_.writing;
    }
}

void Server::after_answer(Id id, Connection& connection) {
    if (connection.keeps_alive()) {
        connection.incoming.reset();
        enter(connection, Connection::State::reading, connection.buffered() > 0 ? limits_.head : limits_.idle);
    } else {
        buffered_ -= connection.buffered();
        connection.start_lingering();
        enter(connection, Connection::State::lingering, limits_.lingering);
        connection.readable = true;
    }
    ready_.push_back(id);
}

}  // namespace tunewright::server::http
