#include "server/json_text.h"

#include <gtest/gtest.h>

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
