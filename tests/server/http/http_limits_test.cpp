#include <gmock/gmock.h>

#include <array>
#include <mutex>
#include <vector>

#include "server/http/body/body_stream.h"
#include "tests/server/http/loopback.h"

namespace tunewright::server::http {
namespace {

using testing::EndsWith;

constexpr std::size_t kClients = 6;
constexpr std::size_t kEach = 24 * 1024 * 1024;

TEST(Unsent, AnswersThatNobodyTakesGoTheOldestFirst) {
    std::array<std::shared_ptr<BodyStream>, kClients> streams;
    std::promise<void> first_left;
    for (auto& stream : streams) {
        stream = std::make_shared<BodyStream>();
        stream->write(std::string(kEach, 'x') + "end");
        stream->end();
    }
    streams.front()->on_gone([&] { first_left.set_value(); });
    std::size_t next = 0;
    Limits limits;
    limits.unsent = 50 * 1024 * 1024;
    Loopback server(
        [&](const Request& request, const Reply& reply) {
            Response response;
            if (request.target == "/large")
                response.stream = streams.at(next++);
            else
                response.body = "small";
            reply(std::move(response));
        },
        limits);
    std::array<std::unique_ptr<Client>, kClients> clients;
    for (auto& client : clients) {
        client = std::make_unique<Client>(server);
        client->send(get("/large"));
        // Their order is that of the answers' beginnings.
        client->read_to("\r\n\r\n");
    }
    first_left.get_future().wait();
    EXPECT_LT(clients.front()->read_all().size(), kEach);
    EXPECT_THAT(clients.back()->read_to("end\r\n0\r\n\r\n"), EndsWith("end\r\n0\r\n\r\n"));
    Client other(server);
    other.send(get("/small"));
    EXPECT_THAT(other.read_to("small"), EndsWith("small"));
}

TEST(Room, IsMadeByTheLongestIdleConnectionThenByTheOldestEventStream) {
    std::mutex mutex;
    std::vector<std::shared_ptr<BodyStream>> streams;
    Limits limits;
    limits.connections = 3;
    Loopback server(
        [&](const Request& request, const Reply& reply) {
            Response response;
            if (request.target == "/events") {
                const std::lock_guard lock(mutex);
                streams.push_back(std::make_shared<BodyStream>());
                response.stream = streams.back();
                response.set("Content-Type", "text/event-stream");
            } else {
                response.body = "done";
            }
            reply(std::move(response));
        },
        limits);
    const auto open = [&](const std::string& target, std::string_view end) {
        auto client = std::make_unique<Client>(server);
        client->send(get(target));
        EXPECT_THAT(client->read_to(end), EndsWith(std::string(end)));
        return client;
    };
    const auto first = open("/events", "\r\n\r\n");
    const auto second = open("/events", "\r\n\r\n");
    const auto idle = open("/", "done");
    const auto third = open("/events", "\r\n\r\n");
    EXPECT_EQ(idle->read_all(), "");
    const auto other = open("/", "done");
    EXPECT_EQ(first->read_all(), "0\r\n\r\n");
    {
        const std::lock_guard lock(mutex);
        EXPECT_FALSE(streams[0]->write("x"));
        EXPECT_TRUE(streams[1]->write("x"));
        EXPECT_TRUE(streams[2]->write("x"));
    }
    EXPECT_EQ(second->read_to("x\r\n"), "1\r\nx\r\n");
    EXPECT_EQ(third->read_to("x\r\n"), "1\r\nx\r\n");
}

}  // namespace
}  // namespace tunewright::server::http
