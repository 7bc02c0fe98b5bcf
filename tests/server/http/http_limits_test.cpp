// The total resources of clients: unsent bytes, connections.
#include <gmock/gmock.h>

#include <array>
#include <vector>

#include "server/http/guard/connection.h"
#include "tests/server/http/loopback.h"

namespace tunewright::server::http {
namespace {

using testing::EndsWith;

constexpr std::size_t kClients = 6;
constexpr std::size_t kEach = 24 * 1024 * 1024;

Response answer(const Request& request) {
    Response response;
    response.body = request.target == "/large" ? std::string(kEach, 'x') + "end" : "small";
    return response;
}

TEST(Unsent, AnswersThatNobodyTakesGoTheOldestFirst) {
    ServerLimits limits;
    limits.unsent = 50 * 1024 * 1024;
    Loopback server(answer, limits);
    std::array<std::unique_ptr<Client>, kClients> clients;
    for (auto& client : clients) {
        client = std::make_unique<Client>(server);
        client->send(get("/large"));
        // The order is that in which the answers began.
        client->read_to("\r\n\r\n");
    }
    std::this_thread::sleep_for(2 * Connection::kSocketTimeout);
    EXPECT_LT(clients.front()->read_all().size(), kEach);
    EXPECT_THAT(clients.back()->read_to("end"), EndsWith("end"));
    Client other(server);
    other.send(get("/small"));
    EXPECT_THAT(other.read_to("small"), EndsWith("small"));
}

/// Connections that have sent this part of a request.
std::vector<std::unique_ptr<Client>> begun(const Loopback& server, std::size_t count, std::uint32_t from,
                                           const std::string& bytes) {
    std::vector<std::unique_ptr<Client>> clients;
    for (std::size_t i = 0; i < count; i++) {
        clients.push_back(std::make_unique<Client>(server, 0, from));
        clients.back()->send(bytes);
    }
    return clients;
}

bool is_served(Client& client) {
    client.send(get("/small"));
    return client.read_to("small").ends_with("small");
}

TEST(Connections, UnfinishedRequestsOfWhoeverHasTheMostGiveWay) {
    const std::string head = "POST /small HTTP/1.1\r\nHost: x\r\nContent-Length: 9\r\n\r\n";
    for (const std::string& sent : {std::string("G"), head, head + "body"}) {
        ServerLimits limits;
        limits.connections = 20;
        Loopback server(answer, limits);
        Client idle(server, 0, 3);
        EXPECT_TRUE(is_served(idle));
        // Three times the number of available slots: those of this address displace each other, and no others.
        const auto crowd = begun(server, 60, 2, sent);
        for (int i = 0; i < 20; i++) {
            Client other(server, 0, 4);
            EXPECT_TRUE(is_served(other)) << sent;
        }
        EXPECT_TRUE(is_served(idle)) << sent;
        EXPECT_EQ(crowd.front()->read_all(), "") << sent;
    }
}

}  // namespace
}  // namespace tunewright::server::http
