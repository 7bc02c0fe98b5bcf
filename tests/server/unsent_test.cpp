#include <gmock/gmock.h>

#include <array>

#include "loopback.h"
#include "server/http/body_stream.h"

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

}  // namespace
}  // namespace tunewright::server::http
