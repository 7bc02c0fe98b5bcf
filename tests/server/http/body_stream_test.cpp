#include "server/http/body/body_stream.h"

#include <gmock/gmock.h>

#include <atomic>
#include <vector>

#include "tests/server/http/loopback.h"

namespace tunewright::server::http {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Response stream_response(std::shared_ptr<BodyStream> stream, const std::string& type = "application/x-ndjson") {
    Response response;
    response.stream = std::move(stream);
    return response.set("Content-Type", type);
}

/// Answers /stream with the stream of the test, everything else with "plain".
Handler streaming(const std::shared_ptr<BodyStream>& stream, const std::string& type = "application/x-ndjson") {
    return [stream, type](const Request& request, const Reply& reply) {
        if (request.target == "/stream") return reply(stream_response(stream, type));
        Response response;
        response.body = "plain";
        reply(std::move(response));
    };
}

TEST(BodyStream, SendsEachPieceAsAChunkAndKeepsTheConnection) {
    const auto stream = std::make_shared<BodyStream>();
    Loopback server(streaming(stream));
    Client client(server);
    client.send(get("/stream"));
    const std::string head = client.read_to("\r\n\r\n");
    EXPECT_THAT(head, HasSubstr("Transfer-Encoding: chunked\r\n"));
    EXPECT_THAT(head, Not(HasSubstr("Content-Length")));
    EXPECT_TRUE(stream->write("0123456789abcdef"));
    EXPECT_EQ(client.read_to("f\r\n"), "10\r\n0123456789abcdef\r\n");
    EXPECT_TRUE(stream->write("x"));
    EXPECT_EQ(client.read_to("x\r\n"), "1\r\nx\r\n");
    stream->end();
    EXPECT_EQ(client.read_to("0\r\n\r\n"), "0\r\n\r\n");
    client.send(get("/other", "Connection: close\r\n"));
    EXPECT_THAT(client.read_all(), EndsWith("\r\n\r\nplain"));
}

TEST(BodyStream, BrokenOffSendsWhatThereWasAndNoEnd) {
    const auto stream = std::make_shared<BodyStream>();
    Loopback server(streaming(stream));
    Client client(server);
    client.send(get("/stream"));
    client.read_to("\r\n\r\n");
    stream->write("half");
    stream->break_off();
    EXPECT_EQ(client.read_all(), "4\r\nhalf\r\n");
}

TEST(BodyStream, IsSentWholeWhereAllWasWrittenBeforeTheAnswer) {
    const auto stream = std::make_shared<BodyStream>();
    stream->write("one");
    stream->write("two");
    stream->end();
    Loopback server(streaming(stream));
    Client client(server);
    client.send(get("/stream"));
    EXPECT_THAT(client.read_to("0\r\n\r\n"), EndsWith("\r\n\r\n6\r\nonetwo\r\n0\r\n\r\n"));
}

TEST(BodyStream, EndsWithTheConnectionForClientsOfHttp10) {
    const auto stream = std::make_shared<BodyStream>();
    stream->write("body");
    stream->end();
    Loopback server(streaming(stream));
    Client client(server);
    client.send("GET /stream HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
    const std::string answer = client.read_all();
    EXPECT_THAT(answer, EndsWith("\r\n\r\nbody"));
    EXPECT_THAT(answer, HasSubstr("Connection: close\r\n"));
    EXPECT_THAT(answer, Not(HasSubstr("chunked")));
}

TEST(BodyStream, IsNotMadeForHead) {
    const auto stream = std::make_shared<BodyStream>();
    std::promise<void> left;
    stream->on_gone([&] { left.set_value(); });
    Loopback server(streaming(stream));
    Client client(server);
    client.send("HEAD /stream HTTP/1.1\r\nHost: x\r\n\r\n" + get("/other", "Connection: close\r\n"));
    const std::string answers = client.read_all();
    EXPECT_THAT(answers, HasSubstr("Transfer-Encoding: chunked\r\n"));
    EXPECT_THAT(answers, EndsWith("\r\n\r\nplain"));
    left.get_future().wait();
    EXPECT_FALSE(stream->write("x"));
}

TEST(BodyStream, AsksForMoreOnlyAsTheClientTakesIt) {
    constexpr std::size_t piece = 128 * 1024;
    constexpr std::size_t pieces = 400;
    const auto stream = std::make_shared<BodyStream>();
    std::atomic<std::size_t> made = 0;
    std::atomic<std::size_t> most_waiting = 0;
    stream->on_room([&, weak = std::weak_ptr(stream)] {
        const auto self = weak.lock();
        if (made == pieces) return self->end();
        made++;
        self->write(std::string(piece, 'x'));
        most_waiting = std::max(most_waiting.load(), self->waiting());
    });
    Loopback server(streaming(stream));
    Client client(server, 64 * 1024);
    Client other(server);
    client.send(get("/stream"));
    client.read_to("\r\n\r\n");
    // The client takes nothing: the kernel's buffers fill, then the producer rests and others are served.
    for (int i = 0; i < 50; i++) {
        other.send(get("/other"));
        EXPECT_THAT(other.read_to("plain"), EndsWith("plain"));
    }
    EXPECT_LT(made, pieces);
    client.send(get("/other", "Connection: close\r\n"));
    const std::string rest = client.read_all();
    EXPECT_THAT(rest, EndsWith("plain"));
    EXPECT_EQ(static_cast<std::size_t>(std::count(rest.begin(), rest.end(), 'x')), piece * pieces);
    EXPECT_LE(most_waiting, BodyStream::kRoom);
}

TEST(BodyStream, AnEndlessOneDoesNotKeepOthersWaiting) {
    const auto stream = std::make_shared<BodyStream>();
    stream->on_room([weak = std::weak_ptr(stream)] { weak.lock()->write(std::string(1000, 'x')); });
    Loopback server(streaming(stream));
    Client endless(server);
    endless.send(get("/stream"));
    std::atomic<bool> enough = false;
    std::jthread taker([&] {
        while (!enough) endless.read_to("\r\n");
    });
    Client other(server);
    for (int i = 0; i < 100; i++) {
        other.send(get("/other"));
        EXPECT_THAT(other.read_to("plain"), EndsWith("plain"));
    }
    enough = true;
}

TEST(BodyStream, TellsItsProducerThatAnIdleClientLeft) {
    const auto stream = std::make_shared<BodyStream>();
    std::promise<void> left;
    stream->on_gone([&] { left.set_value(); });
    Loopback server(streaming(stream));
    Client client(server);
    client.send(get("/stream"));
    client.read_to("\r\n\r\n");
    EXPECT_TRUE(stream->write("x"));
    client.close();
    left.get_future().wait();
    EXPECT_TRUE(stream->gone());
    EXPECT_FALSE(stream->write("x"));
}

TEST(BodyStream, IsGivenUpWhereTheClientTakesNothing) {
    const auto stream = std::make_shared<BodyStream>();
    std::promise<void> left;
    stream->on_gone([&] { left.set_value(); });
    stream->write(std::string(32 * 1024 * 1024, 'x'));
    Limits limits;
    limits.writing = std::chrono::milliseconds(300);
    Loopback server(streaming(stream), limits);
    Client client(server);
    client.send(get("/stream"));
    left.get_future().wait();
    EXPECT_FALSE(stream->write("x"));
}

TEST(BodyStream, StaysOpenForAsLongAsNothingWaits) {
    const auto stream = std::make_shared<BodyStream>();
    Limits limits;
    limits.writing = limits.handling = limits.idle = std::chrono::milliseconds(1);
    Loopback server(streaming(stream), limits);
    Client client(server);
    client.send(get("/stream"));
    client.read_to("\r\n\r\n");
    // Longer than two sweeps of the loop.
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    EXPECT_TRUE(stream->write("x"));
    EXPECT_EQ(client.read_to("x\r\n"), "1\r\nx\r\n");
}

TEST(BodyStream, OfEventsEndsProperlyWhenTheServiceStops) {
    const auto stream = std::make_shared<BodyStream>();
    std::promise<void> left;
    stream->on_gone([&] { left.set_value(); });
    Loopback server(streaming(stream, "text/event-stream"));
    Client client(server);
    client.send(get("/stream"));
    client.read_to("\r\n\r\n");
    stream->write("data: 1\n\n");
    client.read_to("data: 1\n\n\r\n");
    server.ask_to_stop();
    EXPECT_EQ(client.read_all(), "0\r\n\r\n");
    left.get_future().wait();
    EXPECT_FALSE(stream->write("x"));
}

TEST(BodyStream, WithAnEndIsFinishedWhenTheServiceStops) {
    const auto stream = std::make_shared<BodyStream>();
    Limits limits;
    limits.stopping = std::chrono::seconds(20);
    Loopback server(streaming(stream), limits);
    Client client(server);
    client.send(get("/stream"));
    client.read_to("\r\n\r\n");
    server.ask_to_stop();
    stream->write("rest");
    stream->end();
    EXPECT_THAT(client.read_all(), StartsWith("4\r\nrest\r\n0\r\n\r\n"));
}

TEST(BodyStream, TheProducerLearnsOfAClientThatLeftBeforeTheAnswer) {
    const auto stream = std::make_shared<BodyStream>();
    std::promise<void> left;
    stream->on_gone([&] { left.set_value(); });
    std::promise<Reply> asked;
    Loopback server([&](const Request&, Reply reply) { asked.set_value(std::move(reply)); });
    Client client(server);
    client.send(get("/stream"));
    const Reply reply = asked.get_future().get();
    client.close();
    reply(stream_response(stream));
    left.get_future().wait();
    EXPECT_TRUE(stream->gone());
}

TEST(BodyStream, AnswersGivenAfterTheServiceStoppedAreGone) {
    const auto stream = std::make_shared<BodyStream>();
    std::promise<Reply> asked;
    Limits limits;
    limits.stopping = std::chrono::milliseconds(1);
    Loopback server([&](const Request&, Reply reply) { asked.set_value(std::move(reply)); }, limits);
    Client client(server);
    client.send(get("/stream"));
    const Reply reply = asked.get_future().get();
    server.stop();
    reply(stream_response(stream));
    EXPECT_TRUE(stream->gone());
}

TEST(BodyStream, FourHundredOpenOnesAreAllServed) {
    std::mutex mutex;
    std::vector<std::shared_ptr<BodyStream>> streams;
    Loopback server([&](const Request&, const Reply& reply) {
        const auto stream = std::make_shared<BodyStream>();
        {
            const std::lock_guard lock(mutex);
            streams.push_back(stream);
        }
        reply(stream_response(stream, "text/event-stream"));
    });
    std::vector<std::unique_ptr<Client>> clients;
    for (int i = 0; i < 400; i++) {
        clients.push_back(std::make_unique<Client>(server));
        clients.back()->send(get("/"));
    }
    for (const auto& client : clients) client->read_to("\r\n\r\n");
    for (int event = 0; event < 20; event++)
        for (const auto& stream : streams) EXPECT_TRUE(stream->write("data: x\n\n"));
    for (const auto& client : clients)
        for (int event = 0; event < 20; event++) EXPECT_THAT(client->read_to("x\n\n"), HasSubstr("data: x\n\n"));
}

}  // namespace
}  // namespace tunewright::server::http
