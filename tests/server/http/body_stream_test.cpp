// Answers that are produced while they are sent.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <vector>

#include "tests/server/http/loopback.h"

namespace tunewright::server::http {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Answers /stream with the producer's output, everything else with "plain".
std::function<Response(Request)> streaming(const BodyProducer& producer) {
    return [producer](const Request& request) {
        Response response;
        if (request.target != "/stream") {
            response.body = "plain";
            return response.set("Content-Type", "a/b");
        }
        response.stream = producer;
        return response.set("Content-Type", "application/x-ndjson");
    };
}

TEST(BodyStream, SendsEachPieceAsAChunkAndKeepsTheConnection) {
    Dictation stream;
    Loopback server(streaming(stream.producer()));
    Client client(server);
    client.send(get("/stream"));
    const std::string head = client.read_to("\r\n\r\n");
    EXPECT_THAT(head, HasSubstr("Transfer-Encoding: chunked\r\n"));
    EXPECT_THAT(head, HasSubstr("Content-Type: application/x-ndjson\r\n"));
    EXPECT_THAT(head, Not(HasSubstr("Content-Length")));
    stream.write("0123456789abcdef");
    EXPECT_EQ(client.read_to("f\r\n"), "10\r\n0123456789abcdef\r\n");
    stream.write("x");
    EXPECT_EQ(client.read_to("x\r\n"), "1\r\nx\r\n");
    stream.end();
    EXPECT_EQ(client.read_to("0\r\n\r\n"), "0\r\n\r\n");
    EXPECT_FALSE(stream.client_left());
    client.send(get("/other", "Connection: close\r\n"));
    EXPECT_THAT(client.read_all(), EndsWith("\r\n\r\nplain"));
}

TEST(BodyStream, BrokenOffSendsWhatThereWasAndNoEnd) {
    Dictation stream;
    Loopback server(streaming(stream.producer()));
    Client client(server);
    client.send(get("/stream"));
    client.read_to("\r\n\r\n");
    stream.write("half");
    client.read_to("half\r\n");
    stream.break_off();
    EXPECT_EQ(client.read_all(), "");
}

TEST(BodyStream, EndsWithTheConnectionForClientsOfHttp10) {
    Dictation stream;
    stream.write("body");
    stream.end();
    Loopback server(streaming(stream.producer()));
    Client client(server);
    client.send("GET /stream HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
    const std::string answer = client.read_all();
    EXPECT_THAT(answer, EndsWith("\r\n\r\nbody"));
    EXPECT_THAT(answer, HasSubstr("Connection: close\r\n"));
    EXPECT_THAT(answer, Not(HasSubstr("chunked")));
}

TEST(BodyStream, IsNotMadeForHead) {
    std::atomic<bool> made = false;
    Loopback server(streaming([&](BodyWriter&) { return made = true; }));
    Client client(server);
    client.send("HEAD /stream HTTP/1.1\r\nHost: x\r\n\r\n" + get("/other", "Connection: close\r\n"));
    const std::string answers = client.read_all();
    EXPECT_THAT(answers, HasSubstr("Transfer-Encoding: chunked\r\n"));
    EXPECT_THAT(answers, EndsWith("\r\n\r\nplain"));
    EXPECT_FALSE(made);
}

TEST(BodyStream, IsMadeOnlyAsTheClientTakesIt) {
    constexpr std::size_t piece = 128 * 1024;
    constexpr std::size_t pieces = 400;
    std::atomic<std::size_t> made = 0;
    Loopback server(streaming([&](BodyWriter& out) {
        while (made < pieces && out.write(std::string(piece, 'x'))) made++;
        return true;
    }));
    Client client(server, 64 * 1024);
    Client other(server);
    client.send(get("/stream"));
    client.read_to("\r\n\r\n");
    // The client reads nothing: the kernel's buffers fill, then the producer waits and others are served.
    for (int i = 0; i < 50; i++) {
        other.send(get("/other"));
        EXPECT_THAT(other.read_to("plain"), EndsWith("plain"));
    }
    EXPECT_LT(made, pieces);
    client.send(get("/other", "Connection: close\r\n"));
    const std::string rest = client.read_all();
    EXPECT_THAT(rest, EndsWith("plain"));
    EXPECT_EQ(static_cast<std::size_t>(std::count(rest.begin(), rest.end(), 'x')), piece * pieces);
}

TEST(BodyStream, TellsItsProducerThatAnIdleClientLeft) {
    Dictation stream;
    Loopback server(streaming(stream.producer()));
    {
        Client client(server);
        client.send(get("/stream"));
        client.read_to("\r\n\r\n");
    }
    EXPECT_TRUE(stream.client_left());
}

TEST(BodyStream, IsGivenUpWhereTheClientTakesNothing) {
    Dictation stream;
    stream.write(std::string(32 * 1024 * 1024, 'x'));
    ServerLimits limits;
    limits.writing = std::chrono::milliseconds(300);
    std::promise<bool> taken;
    Loopback server(streaming([&](BodyWriter& out) {
                        // Small, so that the time limit applies to one piece and not to its length.
                        for (int i = 0; i < 100'000; i++)
                            if (!out.write(std::string(4096, 'x'))) return taken.set_value(false), false;
                        return taken.set_value(true), true;
                    }),
                    limits);
    Client client(server);
    client.send(get("/stream"));
    EXPECT_FALSE(taken.get_future().get());
}

TEST(BodyStream, StaysOpenForAsLongAsNothingWaits) {
    Dictation stream;
    ServerLimits limits;
    limits.writing = limits.idle = std::chrono::milliseconds(1);
    Loopback server(streaming(stream.producer()), limits);
    Client client(server);
    client.send(get("/stream"));
    client.read_to("\r\n\r\n");
    // Longer than two sweeps of the guard.
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    stream.write("x");
    EXPECT_EQ(client.read_to("x\r\n"), "1\r\nx\r\n");
    stream.end();
}

TEST(BodyStream, WithAnEndIsFinishedWhenTheServiceStops) {
    Dictation stream;
    ServerLimits limits;
    limits.stopping = std::chrono::seconds(20);
    Loopback server(streaming(stream.producer()), limits);
    Client client(server);
    client.send(get("/stream"));
    client.read_to("\r\n\r\n");
    server.ask_to_stop();
    stream.write("rest");
    stream.end();
    EXPECT_THAT(client.read_all(), StartsWith("4\r\nrest\r\n0\r\n\r\n"));
}

TEST(BodyStream, IsCutOffWhereItOutlastsTheTimeOfStopping) {
    Dictation stream;
    ServerLimits limits;
    limits.stopping = limits.farewell = std::chrono::milliseconds(1);
    Loopback server(streaming(stream.producer()), limits);
    Client client(server);
    client.send(get("/stream"));
    client.read_to("\r\n\r\n");
    server.stop();
    EXPECT_TRUE(stream.client_left());
    EXPECT_EQ(client.read_all(), "");
}

TEST(BodyStream, FourHundredOpenOnesAreAllServed) {
    std::mutex mutex;
    std::vector<std::unique_ptr<Dictation>> streams;
    Loopback server([&](const Request&) {
        const std::lock_guard lock(mutex);
        Response response;
        response.stream = streams.emplace_back(std::make_unique<Dictation>())->producer();
        return response.set("Content-Type", "text/event-stream");
    });
    std::vector<std::unique_ptr<Client>> clients;
    for (int i = 0; i < 400; i++) {
        clients.push_back(std::make_unique<Client>(server));
        clients.back()->send(get("/"));
    }
    for (const auto& client : clients) client->read_to("\r\n\r\n");
    const std::lock_guard lock(mutex);  // all are there; the lock makes that visible to the observer
    for (const auto& stream : streams) stream->write("data: x\n\n");
    for (const auto& client : clients) EXPECT_THAT(client->read_to("x\n\n"), HasSubstr("data: x\n\n"));
    for (const auto& stream : streams) stream->end();
    for (const auto& client : clients) EXPECT_THAT(client->read_to("0\r\n\r\n"), EndsWith("0\r\n\r\n"));
}

}  // namespace
}  // namespace tunewright::server::http
