// The requests that a connection reads from a client's bytes, independent of the cuts.
#include "server/http/guard/connection.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/server/http/cut_bytes.h"

namespace tunewright::server::http {
namespace {

constexpr std::size_t kAny = 50'000;
const std::string kChunkedHead = "POST / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n";

struct Outcome {
    bool whole = false;
    int status = 0;    ///< of the refusal; 0 if the bytes end too early
    std::string body;  ///< as far as it was read
    bool operator==(const Outcome&) const = default;
};

/// One body that begins after `head`, and whether the next head after it is read correctly.
Outcome body_of(const std::string& head, const std::string& bytes, std::size_t split = kAny, std::size_t limit = 1000) {
    ServerLimits limits;
    limits.max_batch_body = limit;
    const std::string all = head + bytes;
    const CutBytes client(all, [&] { return split; });
    Connection connection(client.socket(), "", "", limits);
    const std::optional<Head> found = connection.next_head();
    EXPECT_TRUE(found && found->state == Head::State::complete) << all;
    connection.start(*found, "");
    connection.expect_body(true);
    Outcome outcome;
    outcome.whole = read_body(connection, outcome.body);
    outcome.status = outcome.whole ? 0 : connection.failed_status();
    EXPECT_EQ(outcome.whole, connection.body_done() && !connection.body_failed());
    if (outcome.whole && bytes.ends_with("GET / HTTP/1.1\r\nHost: x\r\n\r\n")) {
        const std::optional<Head> next = connection.next_head();
        EXPECT_TRUE(next && next->clean.starts_with("GET / ")) << bytes;
    }
    return outcome;
}

Outcome chunks(const std::string& bytes, std::size_t split = kAny, std::size_t limit = 1000) {
    return body_of(kChunkedHead, bytes, split, limit);
}

Outcome stated(std::size_t length, const std::string& bytes, std::size_t split = kAny) {
    return body_of("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: " + std::to_string(length) + "\r\n\r\n", bytes,
                   split);
}

const std::string kNext = "GET / HTTP/1.1\r\nHost: x\r\n\r\n";

TEST(Connection, ReadsAStatedLengthAndLeavesWhatFollows) {
    for (const std::size_t split : {std::size_t{1}, std::size_t{7}, kAny}) {
        EXPECT_EQ(stated(3, "abc" + kNext, split), (Outcome{true, 0, "abc"}));
        EXPECT_EQ(stated(0, kNext, split), (Outcome{true, 0, ""}));
        EXPECT_EQ(stated(4, "abc", split), (Outcome{false, 0, "abc"}));
    }
}

TEST(Connection, ReadsChunksAndLeavesWhatFollows) {
    EXPECT_EQ(chunks("3\r\nabc\r\n0A\r\n0123456789\r\n0\r\n\r\n" + kNext), (Outcome{true, 0, "abc0123456789"}));
    EXPECT_EQ(chunks("0\r\n\r\n"), (Outcome{true, 0, ""}));
    EXPECT_EQ(chunks("a\r\n\r\n\r\n\r\n\r\n\r\n\r\n0\r\n\r\n"), (Outcome{true, 0, "\r\n\r\n\r\n\r\n\r\n"}));
}

TEST(Connection, RefusesChunksThatTwoReadersReadDifferently) {
    for (const char* bytes : {"-2\r\nab\r\n0\r\n\r\n",
                              "+2\r\nab\r\n",
                              " 2\r\nab\r\n",
                              "2 \r\nab\r\n",
                              "0x2\r\nab\r\n",
                              "g\r\n",
                              "\r\n",
                              "\n",
                              "2\nab\n0\n\n",
                              "2;a=b\r\nab\r\n",
                              "2\r\nabc\r\n",
                              "2\r\nab\n0\r\n",
                              "2\r\nab0\r\n\r\n",
                              "000000002\r\nab\r\n",
                              "ffffffffffffffff1\r\n",
                              "2\rab\r\n",
                              "0\r\nTrailer: x\r\n\r\n",
                              "0\r\n\n",
                              "0\r\nGET / HTTP/1.1\r\n",
                              "0\r\n\rx",
                              "2\r\nab\rx"}) {
        const Outcome outcome = chunks(bytes);
        EXPECT_FALSE(outcome.whole) << bytes;
        EXPECT_EQ(outcome.status, 400) << bytes;
        for (std::size_t split = 1; split < 4; split++) EXPECT_EQ(chunks(bytes, split), outcome) << bytes;
    }
}

TEST(Connection, RefusesChunksBeyondTheLimitBeforeTheyCome) {
    EXPECT_TRUE(chunks("5\r\nabcde\r\n5\r\nabcde\r\n0\r\n\r\n", kAny, 10).whole);
    EXPECT_EQ(chunks("5\r\nabcde\r\n6\r\n", kAny, 10), (Outcome{false, 413, "abcde"}));
    EXPECT_EQ(chunks("ffffffff\r\n").status, 413);
}

TEST(Connection, FindsTheSameHoweverTheBytesAreCut) {
    std::mt19937 random(7);
    const std::string alphabet = "0123abF\r\r\n\n;- ";
    for (int i = 0; i < 2'000; i++) {
        std::string bytes = i % 2 == 0 ? "3\r\nabc\r\n" : "";
        const std::size_t size = random() % 24;
        for (std::size_t k = 0; k < size; k++) bytes.push_back(alphabet[random() % alphabet.size()]);
        const Outcome whole = chunks(bytes);
        for (const std::size_t split : {1, 2, 3, 5}) ASSERT_EQ(chunks(bytes, split), whole) << bytes;
    }
}

}  // namespace
}  // namespace tunewright::server::http
