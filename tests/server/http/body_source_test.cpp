// Bodies that are read as they arrive, or gathered.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "tests/server/http/loopback.h"

namespace tunewright::server::http {
namespace {

using namespace std::chrono_literals;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

bool at_batches(const Request& request) { return request.target == "/batches"; }

/// Reads to the end and answers with the body, or with its length if it is long.
Response read_all(const Request& request) {
    Response response;
    if (!request.read_body) {
        response.body = request.body + " whole";
        return response;
    }
    std::string text;
    const bool whole = request.read_body([&](std::string_view piece) {
        EXPECT_GT(piece.size(), 0U);
        text += piece;
        return true;
    });
    response.body = text.size() > 100 ? std::to_string(std::hash<std::string>{}(text)) : text;
    response.body += whole ? " end" : " broken";
    return response;
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
    ServerLimits limits;
    limits.bodies = 1'000'000;
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
    ServerLimits limits;
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

/// Reports whether the handler received the whole body.
std::function<Response(Request)> telling(std::promise<bool>& whole) {
    return [&whole](const Request& request) {
        whole.set_value(request.read_body([](std::string_view) { return true; }));
        return Response();
    };
}

TEST(BodySource, TellsTheReaderOfARefusal) {
    std::promise<bool> whole;
    Loopback server(telling(whole), {}, at_batches);
    Client client(server);
    client.send(post(kChunked) + "no size\r\n");
    EXPECT_THAT(client.read_all(), StartsWith("HTTP/1.1 400"));
    EXPECT_FALSE(whole.get_future().get());
}

TEST(BodySource, TellsAReaderThatTheClientLeft) {
    std::promise<bool> whole;
    Loopback server(telling(whole), {}, at_batches);
    {
        Client client(server);
        client.send(post("Content-Length: 100\r\n") + "part");
    }
    EXPECT_FALSE(whole.get_future().get());
}

TEST(BodySource, TakesNothingFromTheClientWhileNobodyReads) {
    std::promise<void> asked, go;
    Loopback server(
        [&, may_read = go.get_future().share()](const Request& request) {
            asked.set_value();
            may_read.wait();
            return read_all(request);
        },
        {}, at_batches);
    Client client(server);
    std::atomic<bool> sent = false;
    std::jthread sender([&] {
        client.send(post("Content-Length: 60000000\r\n"));
        client.send(std::string(60'000'000, 'x'));
        sent = true;
    });
    asked.get_future().wait();
    // Far more than the kernel's buffers on both sides if the service did not read.
    std::this_thread::sleep_for(300ms);
    EXPECT_FALSE(sent);
    go.set_value();
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
    Loopback server([](const Request&) { return problem_response(401, "No key was given."); }, {}, at_batches);
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
    ServerLimits limits;
    limits.pace_time = 200ms;
    Loopback server(
        [&](const Request& request) {
            if (request.has_header("Slow")) std::this_thread::sleep_for(600ms);
            return read_all(request);
        },
        limits, at_batches);
    Client patient(server);
    patient.send(post("Content-Length: 5\r\nSlow: yes\r\n"));
    Client trickle(server);
    trickle.send(post("Content-Length: 100\r\n") + "x");
    EXPECT_THAT(trickle.read_all(), StartsWith("HTTP/1.1 408"));
    // By now the other client has taken longer than this limit, but only because it waited for the service.
    patient.send("hello");
    EXPECT_THAT(patient.read_to(" end"), EndsWith("hello end"));
}

TEST(BodySource, EndsWithTheService) {
    std::promise<bool> whole;
    ServerLimits limits;
    limits.stopping = limits.farewell = 1ms;
    Loopback server(telling(whole), limits, at_batches);
    Client client(server);
    client.send(post("Content-Length: 5\r\nExpect: 100-continue\r\n"));
    client.read_to("100 Continue\r\n\r\n");
    server.stop();
    EXPECT_FALSE(whole.get_future().get());
}

TEST(BodySource, AGatheredBodyThatDoesNotComeIs408) {
    ServerLimits limits;
    limits.body_time = 100ms;
    Loopback server(read_all, limits);
    Client client(server);
    client.send(post("Content-Length: 5\r\n") + "hell");
    EXPECT_THAT(client.read_all(), StartsWith("HTTP/1.1 408"));
}

TEST(BodySource, BodiesBeyondTheBudgetAreRefusedAndALengthAloneTakesNothing) {
    ServerLimits limits;
    limits.bodies = 1'000'000;
    limits.room = 50ms;
    std::promise<void> held, go;
    Loopback server(
        [&, first_body = true, may_go = go.get_future().share()](const Request& request) mutable {
            if (!request.body.empty() && std::exchange(first_body, false)) held.set_value();
            if (!request.body.empty()) may_go.wait();
            return read_all(request);
        },
        limits);
    std::vector<std::unique_ptr<Client>> silent;
    for (int i = 0; i < 5; i++) {
        silent.push_back(std::make_unique<Client>(server));
        silent.back()->send(post("Content-Length: 900000\r\n"));
    }
    Client first(server), second(server), small(server);
    first.send(post("Content-Length: 700000\r\n") + std::string(700'000, 'x'));
    held.get_future().wait();
    second.send(post("Content-Length: 700000\r\n") + std::string(700'000, 'x'));
    const std::string refused = second.read_all();
    EXPECT_THAT(refused, StartsWith("HTTP/1.1 503"));
    EXPECT_THAT(refused, HasSubstr("Retry-After: "));
    // A request without a body needs no room.
    small.send(get("/"));
    EXPECT_THAT(small.read_to("whole"), EndsWith("whole"));
    go.set_value();
    EXPECT_THAT(first.read_to("whole"), EndsWith("whole"));
    // An answered request has released its room.
    Client third(server);
    third.send(post("Content-Length: 700000\r\n") + std::string(700'000, 'x'));
    EXPECT_THAT(third.read_to("whole"), EndsWith("whole"));
}

}  // namespace
}  // namespace tunewright::server::http
