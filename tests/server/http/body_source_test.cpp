#include "server/http/body/body_source.h"

#include <gmock/gmock.h>
#include <cstdint>

#include <atomic>

#include "tests/server/http/loopback.h"

namespace tunewright::server::http {
namespace {

using namespace std::chrono_literals;
using State = BodySource::State;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

bool at_batches(const Request& request) { return request.target == "/batches"; }

/// Reads to the end and answers with what came: "STATE SIZE HASH".
class Reader : public std::enable_shared_from_this<Reader> {
public:
    Reader(std::shared_ptr<BodySource> source, Reply reply) : source_(std::move(source)), reply_(std::move(reply)) {}

    void next() {
        source_->read([self = shared_from_this()](BodySource::Piece piece) { self->take(std::move(piece)); });
    }

private:
    void take(BodySource::Piece piece) {
        if (piece.state == State::more) {
            EXPECT_GT(piece.bytes.size(), 0U);
            EXPECT_LE(piece.bytes.size(), 256U * 1024);
            text_ += piece.bytes;
            return next();
        }
        Response response;
        response.body = text_.size() > 100 ? std::to_string(std::hash<std::string>{}(text_)) : text_;
        response.body += piece.state == State::end ? " end" : " broken";
        reply_(std::move(response));
    }

    std::shared_ptr<BodySource> source_;
    Reply reply_;
    std::string text_;
};

void read_all(Request request, Reply reply) {
    if (!request.source) {
        Response response;
        response.body = request.body + " whole";
        return reply(std::move(response));
    }
    std::make_shared<Reader>(request.source, std::move(reply))->next();
}

std::string post(const std::string& fields, const std::string& target = "/batches") {
    return "POST " + target + " HTTP/1.1\r\nHost: x\r\n" + fields + "\r\n";
}

const std::string kChunked = "Transfer-Encoding: chunked\r\n";

TEST(BodySource, GivesABodyOfStatedLengthAndKeepsTheConnection) {
    Loopback server(read_all, {}, at_batches);
    Client client(server);
    client.send(post("Content-Length: 5\r\n") + "hello" + post("Content-Length: 0\r\n") + post(""));
    EXPECT_THAT(client.read_to(" end"), EndsWith("\r\n\r\nhello end"));
    EXPECT_THAT(client.read_to(" end"), EndsWith("\r\n\r\n end"));
    EXPECT_THAT(client.read_to(" end"), EndsWith("\r\n\r\n end"));
    client.send(post("Content-Length: 2\r\nConnection: close\r\n", "/other") + "ab");
    EXPECT_THAT(client.read_all(), EndsWith("ab whole"));
}

TEST(BodySource, GivesChunksAndReadsTheNextRequestBehindThem) {
    Loopback server(read_all, {}, at_batches);
    Client client(server);
    client.send(post(kChunked) + "3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n" + post("Content-Length: 2\r\n", "/other") + "xy");
    EXPECT_THAT(client.read_to(" end"), EndsWith("\r\n\r\nabcde end"));
    EXPECT_THAT(client.read_to("whole"), EndsWith("\r\n\r\nxy whole"));
}

TEST(BodySource, CarriesMoreThanItHoldsAndLosesNothing) {
    std::string body;
    for (std::int64_t i = 0; body.size() < 20'000'000; i++) body += std::to_string(i * 7919) + "\n";
    const std::string answer = std::to_string(std::hash<std::string>{}(body)) + " end";
    Limits limits;
    limits.buffered = 1'000'000;
    Loopback server(read_all, limits, at_batches);
    Client client(server);
    client.send(post("Content-Length: " + std::to_string(body.size()) + "\r\n"));
    client.send(body);
    EXPECT_THAT(client.read_to(" end"), EndsWith(answer));
    client.send(post(kChunked));
    char line[32];
    for (std::size_t at = 0, n = 1; at < body.size(); at += n, n = (n * 3 + 1) % 300'000) {
        n = std::min(n, body.size() - at);
        std::snprintf(line, sizeof line, "%zx\r\n", n);
        client.send(line + body.substr(at, n) + "\r\n");
    }
    client.send("0\r\n\r\n");
    EXPECT_THAT(client.read_to(" end"), EndsWith(answer));
}

TEST(BodySource, RefusesWhatIsTooLongOrMalformedAndCloses) {
    Limits limits;
    limits.max_batch_body = 10;
    limits.max_body = 5;
    Loopback server(read_all, limits, at_batches);
    const auto answer = [&](const std::string& bytes) {
        Client client(server);
        client.send(bytes + "\r\n\r\n" + get("/other"));
        const std::string text = client.read_all();
        EXPECT_EQ(text.find("HTTP/1.1", 1), std::string::npos) << bytes << text;
        return text.substr(0, 12);
    };
    EXPECT_EQ(answer(post("Content-Length: 11\r\n") + "01234567890"), "HTTP/1.1 413");
    EXPECT_EQ(answer(post("Content-Length: 6\r\n", "/other") + "012345"), "HTTP/1.1 413");
    EXPECT_EQ(answer(post(kChunked) + "6\r\nabcdef\r\n5\r\nabcde\r\n0\r\n\r\n"), "HTTP/1.1 413");
    EXPECT_EQ(answer(post(kChunked) + "-2\r\nab\r\n0\r\n\r\n"), "HTTP/1.1 400");
    EXPECT_EQ(answer(post(kChunked) + "2\r\nab0\r\n\r\n"), "HTTP/1.1 400");
    EXPECT_EQ(answer(post(kChunked) + "2;x=y\r\nab\r\n0\r\n\r\n"), "HTTP/1.1 400");
    EXPECT_EQ(answer(post(kChunked) + "2\r\nab\r\n0\r\nX: y\r\n\r\n"), "HTTP/1.1 400");
    EXPECT_EQ(answer(post(kChunked + "Content-Length: 2\r\n") + "0\r\n\r\n"), "HTTP/1.1 400");
    EXPECT_EQ(answer(post("Transfer-Encoding: gzip, chunked\r\n") + "0\r\n\r\n"), "HTTP/1.1 400");
    EXPECT_EQ(answer(post(kChunked, "/other") + "0\r\n\r\n"), "HTTP/1.1 411");
}

TEST(BodySource, TellsTheReaderOfARefusal) {
    std::promise<State> seen;
    Loopback server([&](Request request,
                        Reply) { request.source->read([&](BodySource::Piece piece) { seen.set_value(piece.state); }); },
                    {}, at_batches);
    Client client(server);
    client.send(post(kChunked) + "no size\r\n");
    EXPECT_THAT(client.read_all(), StartsWith("HTTP/1.1 400"));
    EXPECT_EQ(seen.get_future().get(), State::refused);
}

TEST(BodySource, TellsAReaderThatTheClientLeftEvenLater) {
    std::promise<std::shared_ptr<BodySource>> given;
    Loopback server([&](Request request, Reply) { given.set_value(request.source); }, {}, at_batches);
    Client client(server);
    client.send(post("Content-Length: 100\r\n") + "part");
    const auto source = given.get_future().get();
    const auto read = [&] {
        std::promise<BodySource::Piece> piece;
        source->read([&](BodySource::Piece got) { piece.set_value(std::move(got)); });
        return piece.get_future().get();
    };
    EXPECT_EQ(read().bytes, "part");
    client.close();
    EXPECT_EQ(read().state, State::gone);
    EXPECT_EQ(read().state, State::gone);
    server.stop();
    EXPECT_EQ(read().state, State::gone);
}

TEST(BodySource, TakesNothingFromTheClientWhileNobodyReads) {
    std::promise<std::pair<std::shared_ptr<BodySource>, Reply>> given;
    Loopback server(
        [&](Request request, Reply reply) {
            given.set_value({request.source, std::move(reply)});
        },
        {}, at_batches);
    Client client(server);
    std::atomic<bool> sent = false;
    std::jthread sender([&] {
        client.send(post("Content-Length: 60000000\r\n"));
        client.send(std::string(60'000'000, 'x'));
        sent = true;
    });
    auto [source, reply] = given.get_future().get();
    // Far more than the kernel's buffers of both sides would take if the loop read along.
    std::this_thread::sleep_for(300ms);
    EXPECT_FALSE(sent);
    std::make_shared<Reader>(source, reply)->next();
    EXPECT_THAT(client.read_to(" end"), EndsWith(" end"));
    sender.join();
    EXPECT_TRUE(sent);
}

TEST(BodySource, AsksForTheBodyWhenTheHandlerReads) {
    Loopback server(read_all, {}, at_batches);
    Client client(server);
    client.send(post("Content-Length: 5\r\nExpect: 100-continue\r\n"));
    EXPECT_EQ(client.read_to("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
    client.send("hello");
    EXPECT_THAT(client.read_to(" end"), EndsWith("hello end"));
}

TEST(BodySource, AnAnswerBeforeTheEndClosesAndIsNotLost) {
    Loopback server([](const Request&, const Reply& reply) { reply(problem_response(401, "No key was given.")); }, {},
                    at_batches);
    Client eager(server);
    eager.send(post("Content-Length: 3000000\r\n"));
    eager.send(std::string(3'000'000, 'x'));
    const std::string answer = eager.read_all();
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 401"));
    EXPECT_THAT(answer, HasSubstr("Connection: close\r\n"));
    Client patient(server);
    patient.send(post("Content-Length: 3000000\r\nExpect: 100-continue\r\n"));
    EXPECT_THAT(patient.read_all(), StartsWith("HTTP/1.1 401"));
}

TEST(BodySource, ATrickleIsCutOffAndASlowReaderIsNot) {
    Limits limits;
    limits.pace_time = 200ms;
    limits.handling = 20s;
    std::promise<std::pair<std::shared_ptr<BodySource>, Reply>> given;
    Loopback server(
        [&](Request request, Reply reply) {
            if (request.has_header("Slow")) return given.set_value({request.source, std::move(reply)});
            read_all(std::move(request), std::move(reply));
        },
        limits, at_batches);
    Client patient(server);
    patient.send(post("Content-Length: 5\r\nSlow: yes\r\n"));
    Client trickle(server);
    trickle.send(post("Content-Length: 100\r\n") + "x");
    EXPECT_THAT(trickle.read_all(), StartsWith("HTTP/1.1 408"));
    // By now the other one has waited longer than that, but for us.
    auto [source, reply] = given.get_future().get();
    patient.send("hello");
    std::make_shared<Reader>(source, reply)->next();
    EXPECT_THAT(patient.read_to(" end"), EndsWith("hello end"));
}

TEST(BodySource, EndsWithTheService) {
    std::promise<State> seen;
    Limits limits;
    limits.stopping = 1ms;
    std::promise<void> reading;
    Loopback server(
        [&](Request request, Reply) {
            request.source->read([&](BodySource::Piece piece) { seen.set_value(piece.state); });
            reading.set_value();
        },
        limits, at_batches);
    Client client(server);
    client.send(post("Content-Length: 5\r\n"));
    reading.get_future().wait();
    server.stop();
    EXPECT_EQ(seen.get_future().get(), State::gone);
}

}  // namespace
}  // namespace tunewright::server::http
