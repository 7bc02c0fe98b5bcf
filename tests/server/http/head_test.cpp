#include "server/http/guard/head.h"

#include <gmock/gmock.h>

namespace tunewright::server::http {
namespace {

constexpr std::size_t kBody = 1000;

std::string head_of(const std::string& fields) { return "GET /a HTTP/1.1\r\nHost: x\r\n" + fields + "\r\n"; }

/// The head for a call that accepts up to 1,000 bytes.
Head judge(const std::string& text, bool streamed = false) {
    Head head = read_head(text);
    if (head.state == Head::State::complete) refuse_body(head, streamed, kBody);
    return head;
}

void expect_refused(const std::string& text, int status, bool streamed = false) {
    const Head head = judge(text, streamed);
    EXPECT_EQ(head.state, Head::State::refused) << text;
    EXPECT_EQ(head.status, status) << text;
    EXPECT_GT(head.detail.size(), 20U);
}

TEST(Head, IsIncompleteAtEveryPrefix) {
    const std::string whole = head_of("Content-Length: 3\r\n");
    for (std::size_t n = 0; n < whole.size(); n++)
        EXPECT_EQ(read_head(whole.substr(0, n)).state, Head::State::incomplete) << n;
    EXPECT_EQ(read_head(whole).state, Head::State::complete);
}

TEST(Head, TellsWhereItEndsAndHowLongTheBodyIs) {
    const std::string text = head_of("Content-Length: 42\r\n");
    const Head head = read_head(text + "{\"a\": 1}");
    EXPECT_EQ(head.size, text.size());
    EXPECT_EQ(head.content_length, 42U);
    EXPECT_TRUE(head.keep_alive);
}

TEST(Head, KeepsTheConnectionAsVersionAndClientSay) {
    EXPECT_FALSE(read_head(head_of("Connection: close\r\n")).keep_alive);
    EXPECT_FALSE(read_head(head_of("connection: foo, CLOSE\r\n")).keep_alive);
    EXPECT_FALSE(read_head("GET / HTTP/1.0\r\n\r\n").keep_alive);
    EXPECT_TRUE(read_head("GET / HTTP/1.0\r\nConnection: keep-alive\r\n\r\n").keep_alive);
    EXPECT_FALSE(read_head(head_of("Connection: close\r\nConnection: x\r\n")).keep_alive);
    EXPECT_FALSE(read_head(head_of("Connection: keep-alive\r\nConnection: close\r\n")).keep_alive);
}

TEST(Head, GivesTheLibraryNothingThatItWouldActUpon) {
    const Head head = read_head(
        head_of("Range: bytes=0-,0-\r\nREMOTE_ADDR: 1.2.3.4\r\nExpect: 100-continue\r\nA:  b%41 \r\nA: c\r\n"));
    EXPECT_TRUE(head.expects_continue);
    EXPECT_EQ(head.clean, "GET /a HTTP/1.1\r\n\r\n");
    EXPECT_EQ(read_head(head_of("Content-Length: 007\r\n")).clean, "GET /a HTTP/1.1\r\nContent-Length: 7\r\n\r\n");
    // Handlers get the fields as sent.
    using Field = std::pair<std::string, std::string>;
    EXPECT_EQ(head.fields.back(), Field("A", "c"));
    EXPECT_EQ(head.fields.at(head.fields.size() - 2), Field("A", "b%41"));
}

TEST(Head, RefusesWhatTwoParsersReadDifferently) {
    expect_refused(head_of("Content-Length: 1\r\nContent-Length: 1\r\n"), 400);
    for (const char* length : {"", "-1", "+1", "1 1", "0x1", "1e2", "99999999999999999999", "1,1"})
        expect_refused(head_of(std::string("Content-Length: ") + length + "\r\n"), 400);
    expect_refused(head_of("Transfer-Encoding: chunked\r\n"), 411);
    expect_refused(head_of("Transfer-Encoding: identity\r\n"), 411);
    expect_refused(head_of("Content-Length: 5\r\nTransfer-Encoding: chunked\r\n"), 400);
    expect_refused(head_of("Transfer-Encoding: chunked\r\nContent-Length: 5\r\n"), 400);
    expect_refused(head_of("Host: y\r\n"), 400);
    expect_refused("GET / HTTP/1.1\r\n\r\n", 400);
    expect_refused(head_of("A: b\r\n c\r\n"), 400);
    expect_refused(head_of("A : b\r\n"), 400);
    expect_refused(head_of(": b\r\n"), 400);
    expect_refused(head_of("A b\r\n"), 400);
    expect_refused(head_of(std::string("A: b") + '\0' + "\r\n"), 400);
    expect_refused(head_of("A: b\rC: d\r\n"), 400);
    expect_refused("GET / HTTP/1.1\nHost: x\r\n\r\n", 400);
}

TEST(Head, TakesATargetWithTheNameOfTheHost) {
    const auto first_line = [](const std::string& target, const std::string& host) {
        const Head head = read_head("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
        return head.state == Head::State::complete ? head.clean.substr(0, head.clean.find("\r\n")) : head.detail;
    };
    EXPECT_EQ(first_line("http://x/a?b=1", "x"), "GET /a?b=1 HTTP/1.1");
    EXPECT_EQ(first_line("HTTPS://x:80/a", "X:80"), "GET /a HTTP/1.1");
    EXPECT_EQ(first_line("http://x", "x"), "GET / HTTP/1.1");
    EXPECT_EQ(first_line("http://x?b", "x"), "GET /?b HTTP/1.1");
    expect_refused("GET http://y/a HTTP/1.1\r\nHost: x\r\n\r\n", 400);
    expect_refused("GET http://x@y/a HTTP/1.1\r\nHost: y\r\n\r\n", 400);
    expect_refused("GET http://x/a HTTP/1.1\r\n\r\n", 400);
    using Field = std::pair<std::string, std::string>;
    EXPECT_EQ(read_head("GET http://x/a HTTP/1.0\r\n\r\n").fields.back(), Field("Host", "x"));
}

TEST(Head, SkipsOneEmptyLineBeforeARequest) {
    const Head head = read_head("\r\n" + head_of(""));
    EXPECT_EQ(head.state, Head::State::complete);
    EXPECT_EQ(head.size, 2 + head_of("").size());
    expect_refused("\r\n\r\n" + head_of(""), 400);
    expect_refused("\n" + head_of(""), 400);
}

TEST(Head, RefusesABareLineFeedAsSoonAsItComes) {
    const std::string text = "GET / HTTP/1.1\r\nHost: x\n";
    expect_refused(text, 400);
    EXPECT_FALSE(may_be_read(text.substr(0, text.size() - 1), 0));
    EXPECT_TRUE(may_be_read(text, text.size() - 4));
    EXPECT_FALSE(may_be_read("GET / HTTP/1.1\r\n", 15)) << "its CR has been looked at";
    EXPECT_EQ(read_head(head_of("Content-Length: 2\r\n") + "\n\n").state, Head::State::complete) << "of the body";
}

TEST(Head, RefusesRequestLinesThatAreNone) {
    for (const char* line : {"", " ", "GET", "GET /", "GET  HTTP/1.1", "GE T / HTTP/1.1", "GET a HTTP/1.1",
                             "GET http:/x HTTP/1.1", "GET http:///a HTTP/1.1", "GET ftp://x/ HTTP/1.1",
                             "G\x80T / HTTP/1.1", "GET /\xc3\xa4 HTTP/1.1", "GET / http/1.1"})
        expect_refused(std::string(line) + "\r\nHost: x\r\n\r\n", 400);
    expect_refused("GET / HTTP/2.0\r\nHost: x\r\n\r\n", 505);
}

TEST(Head, RefusesWhatIsTooLarge) {
    expect_refused("GET /" + std::string(9000, 'a'), 414);
    expect_refused("GET /" + std::string(9000, 'a') + " HTTP/1.1\r\nHost: x\r\n\r\n", 414);
    expect_refused(head_of("A: " + std::string(9000, 'b') + "\r\n"), 431);
    std::string many;
    for (int i = 0; i < 101; i++) many += "A: b\r\n";
    expect_refused(head_of(many), 431);
    std::string endless = "GET / HTTP/1.1\r\n";
    while (endless.size() < kMaxHeadBytes) endless += "A: " + std::string(1000, 'b') + "\r\n";
    expect_refused(endless, 431);
    expect_refused(head_of("Content-Length: 1001\r\n"), 413);
    EXPECT_EQ(judge(head_of("Content-Length: 1000\r\n")).state, Head::State::complete);
}

TEST(Head, TakesChunksOnlyWhereBodiesAreStreamedAndNothingElseEncodesThem) {
    const Head head = judge(head_of("Transfer-Encoding: Chunked\r\n"), true);
    EXPECT_EQ(head.state, Head::State::complete);
    EXPECT_EQ(head.transfer, Head::Transfer::chunked);
    EXPECT_EQ(judge(head_of("Content-Length: 1000\r\n"), true).state, Head::State::complete);
    expect_refused(head_of("Content-Length: 1001\r\n"), 413, true);
    for (const char* coding :
         {"", "identity", "gzip", "gzip, chunked", "chunked, chunked", "chunked;q=1", "xchunked", "\vchunked"})
        expect_refused(head_of(std::string("Transfer-Encoding: ") + coding + "\r\n"), 400, true);
    expect_refused(head_of("Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n"), 400, true);
    expect_refused(head_of("Transfer-Encoding: chunked\r\nContent-Length: 0\r\n"), 400, true);
    expect_refused("POST / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n", 400, true);
}

TEST(Head, RefusesCompressedBodiesAndUnknownExpectations) {
    expect_refused(head_of("Content-Encoding: gzip\r\n"), 415);
    expect_refused(head_of("Expect: wonders\r\n"), 417);
}

}  // namespace
}  // namespace tunewright::server::http
