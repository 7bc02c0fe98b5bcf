#include <gmock/gmock.h>

#include <atomic>
#include <vector>

#include "tests/server/http/loopback.h"

namespace tunewright::server::http {
namespace {

using namespace std::chrono_literals;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

void answer_done(const Request&, const Reply& reply) {
    Response response;
    response.body = "done";
    reply(std::move(response));
}

TEST(Stop, UnderLoadCutsNoRequestOff) {
    Loopback server(answer_done);
    constexpr int kClients = 8;
    std::atomic<int> answered = 0;
    std::atomic<int> said_goodbye = 0;
    std::vector<std::jthread> clients;
    for (int i = 0; i < kClients; i++) {
        clients.emplace_back([&] {
            Client client(server);
            for (;;) {
                EXPECT_TRUE(client.send(get("/")));
                const std::string answer = client.read_to("done");
                ASSERT_THAT(answer, EndsWith("done"));
                answered++;
                if (answer.find("Connection: close") == std::string::npos) continue;
                EXPECT_EQ(client.read_all(), "");
                said_goodbye++;
                return;
            }
        });
    }
    while (answered < 1000) std::this_thread::yield();
    server.stop();
    clients.clear();
    EXPECT_EQ(said_goodbye, kClients);
}

TEST(Stop, WaitsForAnAnswerThatIsBeingMade) {
    std::promise<Reply> asked;
    Limits limits;
    limits.stopping = 20s;
    Loopback server([&](const Request&, Reply reply) { asked.set_value(std::move(reply)); }, limits);
    Client client(server);
    client.send(get("/"));
    const Reply reply = asked.get_future().get();
    server.ask_to_stop();
    answer_done({}, reply);
    const std::string answer = client.read_all();
    EXPECT_THAT(answer, EndsWith("done"));
    EXPECT_THAT(answer, HasSubstr("Connection: close"));
}

TEST(Stop, AnswersARequestThatHasOnlyHalfArrived) {
    Limits limits;
    limits.stopping = 20s;
    limits.farewell = 20s;
    Loopback server(answer_done, limits);
    Client client(server);
    const std::string request = get("/");
    client.send(request.substr(0, 10));
    server.ask_to_stop();
    client.send(request.substr(10));
    EXPECT_THAT(client.read_all(), StartsWith("HTTP/1.1 200"));
}

TEST(Stop, DoesNotWaitForWhoNeverEnds) {
    Limits limits;
    limits.stopping = 300ms;
    Loopback server([](const Request&, const Reply&) {}, limits);
    Client waiting(server);
    waiting.send(get("/"));
    Client half(server);
    half.send("GET / HT");
    Client silent(server);
    // Ends at all: the test has a time-out.
    server.stop();
    EXPECT_EQ(waiting.read_all(), "");
    EXPECT_EQ(half.read_all(), "");
    EXPECT_EQ(silent.read_all(), "");
}

}  // namespace
}  // namespace tunewright::server::http
