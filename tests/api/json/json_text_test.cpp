// Numbers as text, strict parsing, canonical form, digest.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "api/json/digest.h"
#include "api/json/json.h"
#include "api/json/utf8.h"
#include "api/json/writer.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

TEST(SixDigits, AgreeWithTheLibrarysRoundingOverAllMagnitudes) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> mantissa(1, 10), exponent(-290, 290);
    for (int i = 0; i < 20'000; ++i) {
        const double value = (i % 2 ? -1 : 1) * mantissa(random) *
                             std::pow(10, i % 4 ? std::round(exponent(random) / 40) : std::round(exponent(random)));
        char expected[40];
        std::snprintf(expected, sizeof expected, "%.6g", value);
        ASSERT_EQ(std::stod(six_digits(value)), std::stod(expected)) << six_digits(value) << " for " << expected;
    }
}

TEST(SixDigits, AreWrittenAsPeopleWriteThem) {
    EXPECT_EQ(six_digits(0), "0");
    EXPECT_EQ(six_digits(-0.0), "0");
    EXPECT_EQ(six_digits(100000), "100000");
    EXPECT_EQ(six_digits(1234567), "1234570");
    EXPECT_EQ(six_digits(0.1), "0.1");
    EXPECT_EQ(six_digits(-0.000012345678), "-0.0000123457");
    EXPECT_EQ(six_digits(9.999996), "10");
    EXPECT_EQ(six_digits(999999.5), "1000000");
    EXPECT_EQ(six_digits(2.5e-9), "2.5e-9");
    EXPECT_EQ(six_digits(5e-324), "4.94066e-324");
}

TEST(FullDigits, ReadBackAsTheSameDouble) {
    std::mt19937_64 random(11);
    for (int i = 0; i < 20'000; ++i) {
        const double value = std::bit_cast<double>(random());
        if (!std::isfinite(value)) continue;
        ASSERT_EQ(std::strtod(full_digits(value).c_str(), nullptr), value);
    }
    EXPECT_EQ(full_digits(100000), "100000");
    EXPECT_EQ(full_digits(0.1), "0.1");
}

TEST(Writer, NeverWritesNaNOrInfinity) {
    Writer out;
    out.begin_array();
    out.number(std::nan(""));
    out.number(INFINITY);
    out.trace_number(-INFINITY);
    out.trace(std::vector<double>{1, std::nan(""), 2});
    out.end_array();
    EXPECT_EQ(out.view(), "[null,null,null,[1,null,2]]");
}

TEST(Writer, EscapesTextsSoThatTheyReadBack) {
    const std::string text = std::string("a\"b\\c\n\t\r\x01") + "\xC3\xA9";
    Writer out;
    out.text(text);
    EXPECT_EQ(Json::parse(out.view()).get<std::string>(), text);
}

TEST(Parse, KeepsTheOrderOfMembersAndTheirValues) {
    const auto parsed = parse(R"( {"b": [1, {"x": null}], "a": true, "c": "t"} )");
    EXPECT_EQ(std::get<Json>(parsed).dump(), R"({"b":[1,{"x":null}],"a":true,"c":"t"})");
}

TEST(Parse, TakesTheSameNameInDifferentObjects) {
    EXPECT_TRUE(std::holds_alternative<Json>(parse(R"([{"a": 1}, {"a": 2}])")));
}

TEST(Compact, LeavesTextsAlone) {
    EXPECT_EQ(compact("{ \"a b\" : \"c \\\" d\\\\\" ,\n \"e\":[ 1.50 ] }"), "{\"a b\":\"c \\\" d\\\\\",\"e\":[1.50]}");
}

TEST(Canonical, IsOneSpellingForEqualRequests) {
    EXPECT_EQ(canonical(Json::parse(R"({"b": 1.0, "a": [1e2, "x"]})")),
              canonical(Json::parse(R"({"a":[100,"x"],"b":1})")));
    EXPECT_NE(canonical(Json::parse(R"({"b": 1})")), canonical(Json::parse(R"({"b": 1.0000000001})")));
}

// FIPS 180-4's sample messages.
TEST(Digest, IsSha256) {
    EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256_hex(std::string(1'000'000, 'a')),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Indented, ReadsTheSameAndKeepsWhatIsSmallOnALine) {
    const std::string text = R"({"a":{"b":[1,2,{"c":"x, \"y\": [z]"}],"d":{}},"e":[1.50,-2e-9],"f":[]})";
    const std::string lines = indented(text);
    EXPECT_EQ(compact(lines), text);
    EXPECT_EQ(lines,
              "{\n"
              "  \"a\": {\n"
              "    \"b\": [\n"
              "      1,\n"
              "      2,\n"
              "      {\"c\": \"x, \\\"y\\\": [z]\"}\n"
              "    ],\n"
              "    \"d\": {}\n"
              "  },\n"
              "  \"e\": [1.50, -2e-9],\n"
              "  \"f\": []\n"
              "}\n");
}

TEST(WholeCharacters, NoneIsParted) {
    EXPECT_EQ(whole_characters("abc", 5), "abc");
    EXPECT_EQ(whole_characters("abc", 2), "ab");
    EXPECT_EQ(whole_characters("a\u00fcb", 2), "a");
    EXPECT_EQ(whole_characters("a\u00fcb", 3), "a\u00fc");
    EXPECT_EQ(whole_characters("\u20ac\u20ac", 5), "\u20ac");
    EXPECT_EQ(whole_characters("\u20ac", 0), "");
}

}  // namespace
}  // namespace tunewright::api
