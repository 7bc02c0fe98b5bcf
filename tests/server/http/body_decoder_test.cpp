#include "server/http/body/body_decoder.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace tunewright::server::http {
namespace {

constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
using State = BodyDecoder::State;

struct Outcome {
    State state = State::more;
    int status = 0;
    std::string body;
    std::string rest;

    bool operator==(const Outcome&) const = default;
};

/// Feeds `bytes` in pieces of at most `split`.
Outcome decode(BodyDecoder decoder, const std::string& bytes, std::size_t split = kAny, std::size_t room = kAny) {
    Outcome outcome;
    std::string buffer;
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t n = std::min(split, bytes.size() - at);
        buffer.append(bytes, at, n);
        at += n;
        for (std::size_t used = 1; used > 0;) {
            used = decoder.decode(buffer, outcome.body, room);
            buffer.erase(0, used);
        }
    }
    outcome.state = decoder.state();
    outcome.status = decoder.status();
    outcome.rest = outcome.state == State::refused ? "" : buffer;
    return outcome;
}

Outcome chunks(const std::string& bytes, std::size_t split = kAny, std::size_t limit = 1000) {
    return decode(BodyDecoder::of_chunks(limit), bytes, split);
}

TEST(BodyDecoder, ReadsAStatedLengthAndLeavesWhatFollows) {
    EXPECT_EQ(decode(BodyDecoder::of_length(3), "abcGET /"), (Outcome{State::done, 0, "abc", "GET /"}));
    EXPECT_EQ(decode(BodyDecoder::of_length(0), ""), (Outcome{State::done, 0, "", ""}));
    EXPECT_EQ(decode(BodyDecoder::of_length(4), "abc"), (Outcome{State::more, 0, "abc", ""}));
}

TEST(BodyDecoder, ReadsChunksAndLeavesWhatFollows) {
    EXPECT_EQ(chunks("3\r\nabc\r\n0A\r\n0123456789\r\n0\r\n\r\nGET /"),
              (Outcome{State::done, 0, "abc0123456789", "GET /"}));
    EXPECT_EQ(chunks("0\r\n\r\n"), (Outcome{State::done, 0, "", ""}));
    EXPECT_EQ(chunks("a\r\n\r\n\r\n\r\n\r\n\r\n\r\n0\r\n\r\n"), (Outcome{State::done, 0, "\r\n\r\n\r\n\r\n\r\n", ""}));
}

TEST(BodyDecoder, GivesNoMoreThanThereIsRoomFor) {
    BodyDecoder decoder = BodyDecoder::of_chunks(1000);
    std::string body;
    EXPECT_EQ(decoder.decode("8\r\nabcdefgh\r\n", body, 5), 8U);
    EXPECT_EQ(body, "abcde");
    EXPECT_EQ(decode(BodyDecoder::of_chunks(1000), "8\r\nabcdefgh\r\n0\r\n\r\n", kAny, 3).body, "abcdefgh");
}

TEST(BodyDecoder, RefusesWhatTwoReadersReadDifferently) {
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
        EXPECT_EQ(outcome.state, State::refused) << bytes;
        EXPECT_EQ(outcome.status, 400) << bytes;
        for (std::size_t split = 1; split < 4; split++) EXPECT_EQ(chunks(bytes, split), outcome) << bytes;
    }
}

TEST(BodyDecoder, RefusesChunksBeyondTheLimitBeforeTheyCome) {
    EXPECT_EQ(chunks("5\r\nabcde\r\n5\r\nabcde\r\n0\r\n\r\n", kAny, 10).state, State::done);
    EXPECT_EQ(chunks("5\r\nabcde\r\n6\r\n", kAny, 10), (Outcome{State::refused, 413, "abcde", ""}));
    EXPECT_EQ(chunks("ffffffff\r\n").status, 413);
}

TEST(BodyDecoder, FindsTheSameHoweverTheBytesAreSplit) {
    std::mt19937 random(7);
    const std::string alphabet = "0123abF\r\r\n\n;- ";
    for (int i = 0; i < 20'000; i++) {
        std::string bytes = i % 2 == 0 ? "3\r\nabc\r\n" : "";
        const std::size_t size = random() % 24;
        for (std::size_t k = 0; k < size; k++) bytes.push_back(alphabet[random() % alphabet.size()]);
        const Outcome whole = chunks(bytes);
        for (const std::size_t split : {1, 2, 3, 5}) ASSERT_EQ(chunks(bytes, split), whole) << bytes;
    }
}

}  // namespace
}  // namespace tunewright::server::http
