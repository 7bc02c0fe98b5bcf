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

Response answer_done(const Request&) {
    Response response;
    response.body = "done";
    return response;
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
    std::promise<void> asked, go;
    ServerLimits limits;
    limits.stopping = 20s;
    Loopback server(
        [&, may_go = go.get_future().share()](const Request& request) {
            asked.set_value();
            may_go.wait();
            return answer_done(request);
        },
        limits);
    Client client(server);
    client.send(get("/"));
    asked.get_future().wait();
    server.ask_to_stop();
    go.set_value();
    const std::string answer = client.read_all();
    EXPECT_THAT(answer, EndsWith("done"));
    EXPECT_THAT(answer, HasSubstr("Connection: close"));
}

TEST(Stop, AnswersARequestThatHasOnlyHalfArrived) {
    ServerLimits limits;
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
    ServerLimits limits;
    limits.stopping = 300ms;
    std::promise<void> go;
    Loopback server(
        [may_go = go.get_future().share()](const Request& request) {
            may_go.wait();
            return answer_done(request);
        },
        limits);
    Client waiting(server);
    waiting.send(get("/"));
    Client half(server);
    half.send("GET / HT");
    Client silent(server);
    // It must return: the test has a timeout.
    server.stop();
    EXPECT_EQ(waiting.read_all(), "");
    EXPECT_EQ(half.read_all(), "");
    EXPECT_EQ(silent.read_all(), "");
    // The caller that stops the server learns that a handler still runs.
    EXPECT_FALSE(server.idle_within(1ms));
    go.set_value();
    EXPECT_TRUE(server.idle_within(20s));
}

}  // namespace
}  // namespace tunewright::server::http
