#include "server/http/guard/exchange.h"

#include <algorithm>
#include <array>
#include <ctime>

namespace tunewright::server::http {
namespace {

constexpr std::size_t kPieceBytes = 256 * 1024;
constexpr std::size_t kChunkBytes = 64 * 1024;
constexpr const char* kNoRoom = "Too many requests are being received; try again in a moment.";

using HandlerResponse = httplib::Server::HandlerResponse;

/// True for a character that would end a header's line, or is forbidden in it.
bool is_control(unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; }

/// IMF-fixdate, formatted once a second by each thread.
const std::string& http_date() {
    thread_local std::time_t made_at = 0;
    thread_local std::string text;
    const std::time_t now = std::time(nullptr);
    if (now != made_at) {
        std::tm utc{};
        gmtime_r(&now, &utc);
        std::array<char, 40> buffer{};
        text.assign(buffer.data(), std::strftime(buffer.data(), buffer.size(), "%a, %d %b %Y %H:%M:%S GMT", &utc));
        made_at = now;
    }
    return text;
}

/// The library's sink, adapted for the handlers.
class SinkWriter : public BodyWriter {
public:
    SinkWriter(httplib::DataSink& sink, Connection& stream, UnsentResponses& answers)
        : sink_(sink), stream_(stream), answers_(answers) {}
    // An empty chunk would be the end of the body; the library copies each one, so all are small.
    bool write(std::string_view piece) override {
        bool taken = true;
        for (; taken && !piece.empty(); piece.remove_prefix(std::min(piece.size(), kChunkBytes)))
            taken = sink_.write(piece.data(), std::min(piece.size(), kChunkBytes));
        return taken;
    }
    bool gone() const override { return stream_.gone(); }
    void hold(std::size_t bytes) override {
        held_ = {};
        held_ = answers_.hold(stream_, bytes);
    }

private:
    httplib::DataSink& sink_;
    Connection& stream_;
    UnsentResponses& answers_;
    UnsentResponses::Reservation held_;
};

}  // namespace

Exchange::Exchange(Connection& connection, const Head& head, const Application& application, const ServerLimits& limits,
                   Budget& bodies, UnsentResponses& answers, const std::atomic<bool>& stopping)
    : connection_(connection),
      head_(head),
      application_(application),
      limits_(limits),
      bodies_(bodies),
      answers_(answers),
      stopping_(stopping),
      keep_(head.keep_alive && head.state == Head::State::complete) {
    // The library never sees a refused head, but writes the refusal as an answer to this request.
    constexpr std::string_view nothing = "GET / HTTP/1.1\r\n\r\n";
    connection_.start(head_, head.state == Head::State::complete ? std::string_view(head_.clean) : nothing);
}

Exchange*& Exchange::current() {
    thread_local Exchange* exchange = nullptr;
    return exchange;
}

void Exchange::take(httplib::Request& raw) {
    request_.method = std::move(raw.method);
    request_.target = std::move(raw.target);
    for (auto& [name, value] : raw.params) request_.query.emplace(name, std::move(value));
    request_.segments = path_segments(request_.path());
    for (auto& [name, value] : head_.fields) request_.headers.emplace(std::move(name), std::move(value));
    request_.remote_addr = connection_.address;
    taken_ = true;
    request_.left = [this] { return connection_.gone(); };
    // Only the data that the library uses for routing remain: the presence of a body, and the one handler for each
    // method.
    raw.method = request_.method;
    raw.path = "/";
}

HandlerResponse Exchange::begin(httplib::Response& out) {
    if (auto refusal = refuse_early()) {
        give(*std::move(refusal), out);
        return HandlerResponse::Handled;
    }
    const bool bodiless = head_.content_length == 0 && head_.transfer == Head::Transfer::length && !streamed_;
    if (!bodiless && (request_.method == "POST" || request_.method == "DELETE")) return HandlerResponse::Unhandled;
    give(handled(), out);
    return HandlerResponse::Handled;
}

/// The refusals that do not depend on the body.
std::optional<Response> Exchange::refuse_early() {
    if (head_.state == Head::State::refused) return refused(head_.status, head_.detail);
    streamed_ = application_.streams && application_.streams(request_);
    connection_.expect_body(streamed_);
    refuse_body(head_, streamed_, streamed_ ? limits_.max_batch_body : limits_.max_body);
    if (head_.state == Head::State::refused) return refused(head_.status, head_.detail);
    if (application_.admit) {
        if (auto refusal = application_.admit(request_)) return refusal;
    }
    return std::nullopt;
}

/// Counts received bytes of a body. A body that is read as it arrives is passed on, and counted up to a limit.
bool Exchange::count(std::size_t bytes) {
    if (streamed_) bytes = std::min(bytes, limits_.arriving - std::min(limits_.arriving, come_));
    come_ += bytes;
    return share_->grow(bytes, limits_.room);
}

void Exchange::answer(httplib::Response& out, const httplib::ContentReader& body) {
    const std::string& client = request_.client == connection_.address ? connection_.network : request_.client;
    share_ = std::make_shared<Budget::Reservation>(bodies_.open(client, [this] { connection_.give_way(); }));
    request_.keep = [share = share_](std::size_t bytes) { share->keep(bytes); };
    // The library reads small pieces; they are passed on when no more are available.
    const auto read = [this, &body](const BodyTaker& take) {
        std::string piece;
        const auto pass_on = [&] { return piece.empty() || take(std::exchange(piece, {})); };
        const bool whole = body([&](const char* data, std::size_t size) {
            piece.append(data, size);
            if (connection_.has_more() && piece.size() < kPieceBytes) return true;
            return count(piece.size()) ? pass_on() : connection_.refuse_body(kNoRoom);
        });
        if (whole) share_->arrived(0, {});
        return whole && pass_on() && !connection_.body_failed();
    };
    bool whole = true;
    if (streamed_) {
        request_.read_body = read;
    } else {
        whole = body([this](const char* data, std::size_t size) {
            if (!count(size)) return connection_.refuse_body(kNoRoom);
            request_.body.append(data, size);
            return true;
        });
        const std::size_t more = whole && application_.weight ? application_.weight(request_) : 0;
        if (!share_->arrived(more, limits_.room)) whole = connection_.refuse_body(kNoRoom);
    }
    if (!whole) std::string().swap(request_.body), share_->keep(0);
    // The library sets its own status if it did not receive the whole body.
    Response response = whole ? handled() : Response();
    out.status = 200;
    if (connection_.body_failed()) response = refused(connection_.failed_status(), connection_.failed_detail());
    give(std::move(response), out);
}

Response Exchange::handled() {
    // Data of the request for the refusal if the rest of its body does not arrive.
    Request named;
    named.client = request_.client;
    named.request_id = request_.request_id;
    named.traceparent = request_.traceparent;
    named.answer_headers = request_.answer_headers;
    Response response = application_.handle(std::move(request_));
    request_ = std::move(named);
    share_.reset();
    return response;
}

Response Exchange::refused(int status, const std::string& detail) {
    keep_ = false;
    // The client has disconnected.
    if (status == 0) return {};
    request_.remote_addr = connection_.address;
    return application_.refuse(status, detail, request_);
}

void Exchange::give(Response response, httplib::Response& out) {
    keep_ = keep_ && !response.close && !stopping_ && (!response.stream || !head_.http_1_0);
    out.status = response.status;
    std::string type;
    for (auto& [name, value] : response.headers) {
        if (std::ranges::any_of(value, is_control)) continue;
        if (response.stream && name == "Content-Type")
            type = std::move(value);
        else
            out.headers.emplace(std::move(name), std::move(value));
    }
    if (response.stream) return give_stream(std::move(response.stream), type, out);
    held_ = {};
    held_ = answers_.hold(connection_, response.body.size());
    out.body = std::move(response.body);
}

void Exchange::give_stream(BodyProducer producer, const std::string& type, httplib::Response& out) {
    const auto provider = [this, producer = std::move(producer)](std::size_t, httplib::DataSink& sink) {
        SinkWriter writer(sink, connection_, answers_);
        if (!connection_.flush()) return false;
        connection_.pass_on();
        const bool whole = producer(writer);
        if (whole) sink.done();
        keep_ = keep_ && whole;
        return whole;
    };
    if (head_.http_1_0)
        out.set_content_provider(type, provider);
    else
        out.set_chunked_content_provider(type, provider);
}

/// The library's own fields about the connection describe its intention; these describe the actual behaviour.
void Exchange::finish(httplib::Response& out) {
    if (!taken_) {
        give(refused(400, "The request line or a header field cannot be read."), out);
        out.headers.erase("Content-Length");
        out.headers.emplace("Content-Length", std::to_string(out.body.size()));
    }
    // The rest of a body that a handler stopped reading may be long.
    keep_ = keep_ && (streamed_ ? connection_.body_done() : connection_.drop_body());
    for (const char* name : {"Keep-Alive", "Connection", "Accept-Ranges"}) out.headers.erase(name);
    if (out.status == 204 || out.status == 304) out.headers.erase("Content-Length");
    out.headers.emplace("Date", http_date());
    out.headers.emplace("Connection", keep_ ? "keep-alive" : "close");
}

}  // namespace tunewright::server::http
