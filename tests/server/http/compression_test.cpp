#include "server/http/app/compression.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include "server/http/app/negotiation.h"
#include "tests/server/http/loopback.h"

namespace tunewright::server::http {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::Pair;
using testing::StartsWith;

Request asking(const std::string& encodings, const std::string& tag = "") {
    Request request;
    if (!encodings.empty()) request.headers.emplace("Accept-Encoding", encodings);
    if (!tag.empty()) request.headers.emplace("If-None-Match", tag);
    return request;
}

std::string value_of(const Response& response, const std::string& name) {
    std::string value;
    for (const auto& header : response.headers)
        if (header.first == name) value = header.second;
    return value;
}

/// The output of zlib itself; shorter if the input is cut off.
std::string unpacked(const std::string& packed) {
    z_stream state{};
    inflateInit2(&state, 16 + 15);
    std::string out(4'000'000, '\0');
    state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    state.avail_in = static_cast<uInt>(packed.size());
    state.next_out = reinterpret_cast<Bytef*>(out.data());
    state.avail_out = static_cast<uInt>(out.size());
    inflate(&state, Z_SYNC_FLUSH);
    out.resize(state.total_out);
    inflateEnd(&state);
    return out;
}

std::string numbers(long count) {
    std::string text;
    for (long i = 0; i < count; i++) text += std::to_string(i * i) + ",";
    return text;
}

TEST(Compression, IsChosenByQualities) {
    for (const char* yes : {"gzip", "GZIP", "deflate, gzip;q=0.5", "*", "gzip;q=0.001", "identity;q=0.5, gzip",
                            "br;q=1.0, gzip;q=0.8, *;q=0.1", "gzip ; q=1.000", "identity;q=0, *;q=0.2"})
        EXPECT_TRUE(accepts_gzip(asking(yes))) << yes;
    for (const char* no :
         {"", "identity", "gzip;q=0", "gzip;q=0.000", "*;q=0", "br", "gzip;q=0, *", "identity, gzip;q=0.5", "gzip;q=x",
          "gzip;q=-1", "gzip;q=2", "gzip;q=1e0", "xgzip", "gzip;q="})
        EXPECT_FALSE(accepts_gzip(asking(no))) << no;
}

TEST(Compression, IsForTextAndNeverForEvents) {
    for (const char* yes : {"application/json", "application/problem+json", "text/csv; charset=utf-8", "text/html",
                            "image/svg+xml", "application/x-ndjson", "text/javascript"})
        EXPECT_TRUE(is_compressible(yes)) << yes;
    for (const char* no : {"text/event-stream", "text/event-stream; charset=utf-8", "image/png", "font/woff2",
                           "application/octet-stream", ""})
        EXPECT_FALSE(is_compressible(no)) << no;
}

TEST(Compression, LosesNothing) {
    for (const int count : {0, 1, 1000, 200'000})
        for (const int level : {1, 9}) EXPECT_EQ(unpacked(gzip(numbers(count), level)), numbers(count));
    EXPECT_LT(gzip(numbers(10'000)).size(), numbers(10'000).size() / 2);
}

TEST(Compression, OfPiecesLetsEachBeReadAtOnce) {
    GzipStream stream;
    std::string packed;
    std::string text;
    for (int i = 0; i < 50; i++) {
        text += numbers(i * 100);
        packed += stream.piece(numbers(i * 100));
        EXPECT_EQ(unpacked(packed), text);
    }
    packed += stream.end();
    EXPECT_EQ(unpacked(packed), text);
}

TEST(Compression, OfAnAnswerTellsCachesAndWeakensTheTag) {
    const std::string text = numbers(1000);
    Response packed = json_response(text);
    packed.set("ETag", "\"a\"");
    compress(packed, true);
    EXPECT_EQ(unpacked(packed.body), text);
    EXPECT_EQ(value_of(packed, "Content-Encoding"), "gzip");
    EXPECT_EQ(value_of(packed, "Vary"), "Accept-Encoding");
    EXPECT_EQ(value_of(packed, "ETag"), "W/\"a\"");

    Response plain = json_response(text);
    plain.set("ETag", "\"a\"");
    compress(plain, false);
    EXPECT_EQ(plain.body, text);
    EXPECT_EQ(value_of(plain, "Content-Encoding"), "");
    EXPECT_EQ(value_of(plain, "Vary"), "Accept-Encoding");
    EXPECT_EQ(value_of(plain, "ETag"), "\"a\"");
}

TEST(Compression, LeavesSmallAndOtherBodies) {
    Response small = json_response("{}");
    compress(small, true);
    EXPECT_EQ(small.body, "{}");
    EXPECT_EQ(value_of(small, "Vary"), "Accept-Encoding");
    Response picture;
    picture.body = numbers(1000);
    picture.set("Content-Type", "image/png");
    compress(picture, true);
    EXPECT_EQ(picture.body, numbers(1000));
    EXPECT_EQ(value_of(picture, "Vary"), "");
}

TEST(Compression, OfAConstantKeepsBothFormsUnderTagsThatAnswerEither) {
    const ConstantBody body(numbers(1000), "application/json");
    const Response plain = body.respond(asking(""));
    const Response packed = body.respond(asking("gzip"));
    EXPECT_EQ(plain.body, numbers(1000));
    EXPECT_EQ(unpacked(packed.body), plain.body);
    EXPECT_EQ(value_of(plain, "Vary"), "Accept-Encoding");
    EXPECT_EQ(value_of(packed, "ETag"), "W/" + value_of(plain, "ETag"));
    for (const Response* known : {&plain, &packed}) {
        for (const char* encodings : {"", "gzip"}) {
            const Response again = body.respond(asking(encodings, value_of(*known, "ETag")));
            EXPECT_EQ(again.status, 304);
            EXPECT_EQ(again.body, "");
            EXPECT_EQ(value_of(again, "Vary"), "Accept-Encoding");
            EXPECT_EQ(value_of(again, "Content-Encoding"), "");
        }
    }
    EXPECT_EQ(body.respond(asking("gzip", "\"other\"")).status, 200);
}

TEST(Compression, OfAStreamArrivesPieceByPiece) {
    Dictation stream;
    Loopback server([&](const Request&) {
        Response response;
        response.set("Content-Type", "application/x-ndjson");
        response.stream = stream.producer();
        compress(response, true);
        return response;
    });
    Client client(server);
    client.send(get("/", "Connection: close\r\n"));
    EXPECT_THAT(client.read_to("\r\n\r\n"), HasSubstr("Content-Encoding: gzip\r\n"));
    std::string packed;
    const auto chunk = [&] {
        const std::size_t size = std::stoul(client.read_to("\r\n"), nullptr, 16);
        for (std::string part; part.size() < size + 2;) {
            part += client.read_to("\n");
            if (part.size() >= size + 2) packed.append(part, 0, size);
        }
    };
    stream.write("before;");
    chunk();
    EXPECT_EQ(unpacked(packed), "before;");
    stream.write("after;");
    chunk();
    EXPECT_EQ(unpacked(packed), "before;after;");
    stream.end();
    chunk();
    EXPECT_EQ(unpacked(packed), "before;after;");
    EXPECT_EQ(client.read_all(), "0\r\n\r\n");
}

}  // namespace
}  // namespace tunewright::server::http
