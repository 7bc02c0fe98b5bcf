// The output of parse(), compared with the reader of the tree library, which is another program.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "api/json/json.h"

namespace tunewright::api {
namespace {

std::string as_read(const std::string& text) {
    const auto answer = parse(text);
    if (const auto* problem = std::get_if<Problem>(&answer)) return "refused: " + problem->detail;
    return std::get<Json>(answer).dump();
}

TEST(JsonReading, TakesWhatTheOtherReaderTakesAndWithTheSameValues) {
    for (const std::string text : {"null",
                                   "true",
                                   "false",
                                   "0",
                                   "-0",
                                   "-0.0",
                                   "7",
                                   "-7",
                                   "18446744073709551615",
                                   "18446744073709551616",
                                   "-9223372036854775808",
                                   "-9223372036854775809",
                                   "1e5",
                                   "1E+5",
                                   "1.5e-5",
                                   "1e-400",
                                   "4.9e-324",
                                   "0.1",
                                   "1.7976931348623157e308",
                                   "0.00001e312",
                                   "123456789012345678901234567890",
                                   "2.2250738585072011e-308",
                                   "\"\"",
                                   R"("a\"b\\c\/d\b\f\n\r\t")",
                                   R"("\u00e9 \u20ac \ud83d\ude00 \u0000")",
                                   "\"\xC3\xA9 \xE2\x82\xAC\"",
                                   "[]",
                                   "{}",
                                   " [ 1 , [ ] , { } ] ",
                                   "{\"b\": 1, \"a\": [2, {\"c\": null}], \"\": 3}",
                                   "\xEF\xBB\xBF[1]",
                                   "\"\xED\x9F\xBF\""}) {
        ASSERT_TRUE(Json::accept(text)) << text;
        EXPECT_EQ(as_read(text), Json::parse(text).dump()) << text;
    }
}

TEST(JsonReading, RefusesWhatTheOtherReaderRefuses) {
    using std::string_literals::operator""s;
    for (const std::string& text : {""s,
                                    " "s,
                                    "{"s,
                                    "["s,
                                    "[1"s,
                                    "[1,"s,
                                    "[1,]"s,
                                    "{\"a\""s,
                                    "{\"a\":"s,
                                    "{\"a\":1"s,
                                    "{\"a\":1,}"s,
                                    "{a:1}"s,
                                    "{'a':1}"s,
                                    "01"s,
                                    "-"s,
                                    "+1"s,
                                    "1."s,
                                    ".5"s,
                                    "1e"s,
                                    "1e+"s,
                                    "0x10"s,
                                    "NaN"s,
                                    "Infinity"s,
                                    "-Infinity"s,
                                    "tru"s,
                                    "nul"s,
                                    "[1 2]"s,
                                    "1 2"s,
                                    "{}{}"s,
                                    "[1]]"s,
                                    "\"a"s,
                                    "\"\\x\""s,
                                    "\"\\u12\""s,
                                    "\"\\ud800\""s,
                                    "\"\\udc00\""s,
                                    "{\"\\udc00\": 1}"s,
                                    "\"\\ud800\\u0041\""s,
                                    "\"\t\""s,
                                    "\"\n\""s,
                                    "\"a\0b\""s,
                                    "\0"s,
                                    "\"\xff\""s,
                                    "\"\xC3\""s,
                                    "\"\xED\xA0\x80\""s,
                                    "\"\xC0\x80\""s,
                                    "\"\xF5\x80\x80\x80\""s,
                                    "\"\xC3"s,
                                    "\"a\xE2\x82"s,
                                    "\"\xF0\x9F\x98"s,
                                    "\xF0"s,
                                    "// a\n1"s,
                                    "/* a */ 1"s,
                                    "\xEF\xBB"s,
                                    "\xFE\xFF[1]"s}) {
        ASSERT_FALSE(Json::accept(text)) << text;
        EXPECT_TRUE(as_read(text).starts_with("refused: ")) << text << " was read as " << as_read(text);
    }
}

TEST(JsonReading, TakesNoZeroByteForTheEnd) {
    EXPECT_TRUE(as_read(std::string("[1]\0 2]", 8)).starts_with("refused: "));
    EXPECT_TRUE(as_read(std::string("[1]\0", 4)).starts_with("refused: "));
}

TEST(JsonReading, ReadsEachNumberToTheNearestDouble) {
    std::mt19937_64 random(1);
    std::uniform_int_distribution<int> digit(0, 9), length(1, 25), exponent(-330, 300);
    for (int i = 0; i < 20'000; ++i) {
        std::string text = random() % 2 == 0 ? "-" : "";
        text += std::to_string(1 + digit(random) % 9);
        if (random() % 2 == 0) text += std::to_string(random() % 1'000'000);
        if (random() % 2 == 0) {
            text += '.';
            for (int k = length(random); k > 0; --k) text += std::to_string(digit(random));
        }
        if (random() % 2 == 0) text += "e" + std::to_string(exponent(random));
        ASSERT_EQ(as_read(text), Json::parse(text).dump()) << text;
    }
}

TEST(JsonReading, KeepsLargeMembersWholeWhereverTheyStand) {
    // An object that grows moves its members.
    Json wanted = Json::object();
    for (int k = 0; k < 40; ++k) {
        Json column = Json::array();
        for (int i = 0; i < 50 * k; ++i) column.push_back(i + 0.5);
        wanted["column " + std::to_string(k)] = k % 3 == 0 ? Json{{"inner", column}} : column;
    }
    EXPECT_EQ(as_read(wanted.dump()), wanted.dump());
}

std::string repeated(const std::string& value, std::size_t bytes) {
    std::string text = "[" + value;
    while (text.size() < bytes) text += "," + value;
    return text + "]";
}

TEST(JsonReading, RefusesMoreValuesThanMemoryIsFor) {
    constexpr std::size_t body = 8 << 20;
    for (const std::string value : {R"({"":0})", "{}", "[]", R"("")", R"([[1]])"}) {
        const auto parsed = parse(repeated(value, body));
        ASSERT_TRUE(std::holds_alternative<Problem>(parsed)) << value;
        EXPECT_EQ(std::get<Problem>(parsed).status, 413) << value;
    }
    // A record of ten characters a row, and a file in one string, are normal bodies.
    EXPECT_TRUE(std::holds_alternative<Json>(parse(repeated("23.4567", body))));
    EXPECT_TRUE(std::holds_alternative<Json>(parse("[\"" + std::string(body, ',') + "\"]")));
}

TEST(JsonReading, NamesThePlaceOfWhatItCannotRead) {
    EXPECT_NE(as_read("{\n  \"K\": 2,\n  \"T\": oops}").find("line 3, column 8"), std::string::npos);
    EXPECT_NE(as_read("[1] x").find("line 1, column 5"), std::string::npos);
    EXPECT_NE(as_read("{\"a\": {\"b\": [1, 1" + std::string(400, '0') + "]}}").find("is too large"), std::string::npos);
}

}  // namespace
}  // namespace tunewright::api
