#include <gtest/gtest.h>

#include "server/json_text.h"
#include "server/store/postgres/text.h"

namespace tunewright::server {
namespace {

TEST(JsonText, StringsAreEscapedAndUtf8Kept) {
    EXPECT_EQ(json_string("a\"b\\c\n\x01ü"), R"("a\"b\\c\u000a\u0001ü")");
    EXPECT_EQ(json_string(std::string_view("\0", 1)), R"("\u0000")");
}

TEST(JsonText, ObjectsKeepTheirOrderAndEmptyTextsBecomeNull) {
    EXPECT_EQ(
        std::move(JsonObject().text("a", "x").number("b", -3).boolean("c", true).raw("d", "").raw("e", "[1]")).str(),
        R"({"a":"x","b":-3,"c":true,"d":null,"e":[1]})");
    EXPECT_EQ(std::move(JsonObject()).str(), "{}");
}

TEST(JsonText, MomentsAreIsoInUtcWithMilliseconds) {
    EXPECT_EQ(iso_time(0), "1970-01-01T00:00:00.000Z");
    EXPECT_EQ(iso_time(1714564800123), "2024-05-01T12:00:00.123Z");
}

}  // namespace
}  // namespace tunewright::server

namespace tunewright::server::postgres {
namespace {

using namespace std::string_literals;

TEST(PostgresText, AnyBytesComeBackAsTheyWere) {
    for (int first = 0; first < 256; first++)
        for (int second = 0; second < 256; second++) {
            const std::string text{'a', static_cast<char>(first), static_cast<char>(second), 'b'};
            const std::string column = to_column(text);
            ASSERT_EQ(from_column(column), text) << first << " " << second;
            ASSERT_EQ(column.find('\0'), std::string::npos);
        }
}

TEST(PostgresText, ValidTextStaysAsItIs) {
    for (const std::string& text : {"plain"s, "süß 温度 😀"s, "line\nand\ttab"s, ""s, "\xf4\x8f\xbf\xbf"s})
        EXPECT_EQ(to_column(text), text);
}

TEST(PostgresText, WhatIsNoUtf8IsEscapedByteByByte) {
    EXPECT_EQ(to_column("a\0b"s), "a\x01"s + "00b");
    EXPECT_EQ(to_column("\x01"s), "\x01"s + "01");
    EXPECT_EQ(to_column("\xc0\xaf"s), "\x01"s + "c0\x01"s + "af") << "longer than it need be";
    EXPECT_EQ(to_column("\xed\xa0\x80"s), "\x01"s + "ed\x01"s + "a0\x01"s + "80") << "half of a pair";
    EXPECT_EQ(to_column("\xf4\x90\x80\x80"s), "\x01"s + "f4\x01"s + "90\x01"s + "80\x01"s + "80") << "too high";
    EXPECT_EQ(to_column("\xe6\xb8"s), "\x01"s + "e6\x01"s + "b8") << "cut off";
}

TEST(PostgresText, AnArrayQuotesWhatNeedsIt) {
    TextArray array;
    EXPECT_EQ(array.literal(), "{}");
    array.add(R"({"a": "b\c"})");
    array.add("");
    array.add("NULL");
    EXPECT_EQ(array.literal(), R"({"{\"a\": \"b\\c\"}","","NULL"})");
}

}  // namespace
}  // namespace tunewright::server::postgres
