// The estimated memory of a request before it is answered, and the largest request for the available memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/json/json.h"
#include "server/routes/request_checks.h"

namespace tunewright::server {
namespace {

using testing::HasSubstr;

http::Request request_of(const std::string& type, std::string body) {
    http::Request request;
    request.headers.emplace("Content-Type", type);
    request.body = std::move(body);
    return request;
}

TEST(Weight, ARecordWithinJsonWeighsAtLeastWhatItWeighsByItself) {
    std::string csv;
    for (int i = 0; i < 10'000; i++) csv += "1,2\n";
    const std::size_t alone = handling_weight(request_of("text/csv", csv));
    std::string text;
    for (const char c : csv) text += c == '\n' ? std::string("\\n") : std::string(1, c);
    EXPECT_GE(handling_weight(request_of("application/json", R"({"csv":")" + text + "\"}")), alone);
}

TEST(Weight, OnlyWhatIsQuotedWeighsAsAFileMay) {
    const auto weight = [](const std::string& body) { return handling_weight(request_of("application/json", body)); };
    const std::string texts = R"({"a\"b":"c,d\\"})", numbers = "[1,2,3,4,5,6,7,8,9]";
    const auto beyond_its_tree = [&](const std::string& body) {
        return weight(body) - kStoredCopies * body.size() - api::tree_size(body);
    };
    EXPECT_EQ(beyond_its_tree(texts), 5U * 9);
    EXPECT_EQ(beyond_its_tree(numbers), 0U);
    EXPECT_EQ(beyond_its_tree(""), 0U);
    for (const char* broken : {"\"", "\"\\", "\"abc", "{\"a\\"}) EXPECT_LE(beyond_its_tree(broken), 5U * 4) << broken;
}

TEST(Weight, AnEscapedCharacterWeighsAtLeastTheCharacterThatItMeans) {
    std::string escapes;
    for (int i = 0; i < 1000; i++) escapes += "\\\\\\n";
    EXPECT_GE(api::tree_size('"' + escapes + '"'), 2000U);
}

TEST(Body, TheLargestTakesNoMoreThanHalfOfTheMemory) {
    for (const std::size_t memory : {std::size_t{8} << 20, std::size_t{64} << 20, std::size_t{300} << 20,
                                     std::size_t{512} << 20, std::size_t{4} << 30, std::size_t{64} << 30}) {
        std::size_t body = std::size_t{1} << 40;
        const std::string sentence = fit_body(body, memory);
        EXPECT_THAT(sentence, HasSubstr("--max-body"));
        EXPECT_THAT(sentence, HasSubstr("--memory"));
        ASSERT_GT(body, 0U);
        EXPECT_EQ(fit_body(body, memory), "") << "what is lowered fits";
        std::size_t more = body + body / 100;
        EXPECT_NE(fit_body(more, memory), "") << "and no more than that";
        if (body > 32 << 20) continue;
        std::string numbers(body, '1'), objects, texts = "[\"" + std::string(body - 4, 'x') + "\"]";
        for (std::size_t i = 1; i < body; i += 2) numbers[i] = ',';
        while (objects.size() + 7 < body) objects += "{\"\":0},";
        for (const std::string& json : {numbers, objects, texts})
            EXPECT_LE(json.size() + handling_weight(request_of("application/json", json)), memory / 2) << memory;
        EXPECT_LE(body + handling_weight(request_of("text/csv", texts)), memory / 2) << memory;
    }
}

TEST(Body, TheDefaultsAndARecordOfAMillionSamplesFitAsTheyAre) {
    std::size_t body = 8 << 20;
    EXPECT_EQ(fit_body(body, 256 << 20), "");
    EXPECT_EQ(body, 8U << 20);
    body = 24 << 20;
    EXPECT_EQ(fit_body(body, 512 << 20), "");
}

}  // namespace
}  // namespace tunewright::server
