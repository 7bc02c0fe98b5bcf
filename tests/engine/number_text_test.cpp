// Figures and units are spelled as on the page (tests/data/texts, which the page's tests read too).
#include "engine/number_text.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/request/verdict/finding.h"
#include "tests/test_data.h"

namespace tunewright {
namespace {

const nlohmann::json& texts() {
    static const auto data = nlohmann::json::parse(std::ifstream(test_data("texts/texts.json")));
    return data;
}

TEST(NumberText, FiguresAreSpelledAsOnThePage) {
    ASSERT_FALSE(texts()["figures"].empty());
    for (const auto& row : texts()["figures"])
        EXPECT_EQ(figure_text(row["value"], row["digits"]), row["text"].get<std::string>());
}

TEST(NumberText, UnitsAreSpelledAsOnThePage) {
    ASSERT_FALSE(texts()["units"].empty());
    for (const auto& row : texts()["units"]) {
        EXPECT_EQ(verdict::quotient_unit(row["top"], row["bottom"]), row["quotient"].get<std::string>());
        EXPECT_EQ(verdict::product_unit(row["top"], row["bottom"]), row["product"].get<std::string>());
    }
}

}  // namespace
}  // namespace tunewright
