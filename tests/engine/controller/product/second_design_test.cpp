// A second design for every product: its settings, and its ideal form compared with the block's own transfer functions.
#include "tests/engine/controller/product/second_design.h"
#include "engine/controller/product/to_controller.h"

namespace tunewright::product::second {
namespace {

const Row* row_of(std::string_view id) {
    for (const auto* rows : {&industrial_rows(), &heater_rows(), &software_rows()}) {
        const auto found = rows->find(std::string(id));
        if (found != rows->end()) return &found->second;
    }
    return nullptr;
}

Complex filtered(const Filter& filter, Complex s) {
    const Complex x = filter.Tf * s;
    return filter.type == FilterType::measurement_second_order ? 1.0 / (1.0 + x + 0.5 * x * x) : Complex(1);
}

Law law_of(const IdealPid& pid, Complex s) {
    Law law =
        ideal(pid.Kp, pid.Ti, pid.Td, pid.filter.type == FilterType::derivative ? pid.filter.Tf : 0, pid.b, pid.c, s);
    law.y *= filtered(pid.filter, s);
    return law;
}

class SecondDesign : public ::testing::TestWithParam<std::size_t> {};

TEST_P(SecondDesign, GivesTheSettingsOfThePublishedConversions) {
    const Product& product = catalogue()[GetParam()];
    const Row* row = row_of(product.id);
    ASSERT_NE(row, nullptr) << "no row for " << product.id;
    // dterm_lpf1 begins at 1 Hz, below which this design's filter lies; everything else is exact.
    const auto converted = to_settings(product, kDesign, context_b(), false);
    ASSERT_TRUE(converted) << converted.error().message;
    EXPECT_EQ(converted->settings.size(), row->numbers.size() + row->words.size());
    for (const auto& [name, expected] : row->numbers) {
        const double bounded = name == "dterm_lpf1_hz" ? std::max(expected, 1.0) : expected;
        EXPECT_TRUE(to_digits(number(converted->settings, name), bounded, 1e-9)) << name;
    }
    for (const auto& [name, expected] : row->words) EXPECT_EQ(named(converted->settings, name), expected);
}

TEST_P(SecondDesign, HasTheBlocksOwnTransferFunctionsAsItsTwin) {
    const Product& product = catalogue()[GetParam()];
    const auto converted = to_settings(product, kDesign, context_b(), false);
    ASSERT_TRUE(converted) << converted.error().message;
    std::vector<Note> notes;
    const auto twin = to_controller(product, converted->settings, context_b(), notes);
    ASSERT_TRUE(twin) << twin.error().message;
    const Row& row = *row_of(product.id);
    for (int k = 0; k < 40; ++k) {
        const Complex s(0, 1e-4 * std::pow(1e7, k / 39.0));
        const Law block = row.block(Typed{converted->settings}, s), own = law_of(*twin, s);
        EXPECT_LT(std::abs(block.r - own.r), 1e-12 * std::abs(block.r)) << s;
        EXPECT_LT(std::abs(block.y - own.y), 1e-12 * std::abs(block.y)) << s;
    }
}

TEST_P(SecondDesign, IsRealisedAsTypedInTheBlocksResolution) {
    const Product& product = catalogue()[GetParam()];
    const auto converted = to_settings(product, kDesign, context_b(), false);
    ASSERT_TRUE(converted) << converted.error().message;
    const Settings typed = as_typed(product, converted->settings);
    for (int k = 0; k < 40; ++k) {
        const Complex s(0, 1e-4 * std::pow(1e7, k / 39.0));
        const Law block = row_of(product.id)->block(Typed{typed}, s), own = law_of(converted->realised, s);
        EXPECT_LT(std::abs(block.y - own.y), 1e-12 * std::abs(block.y)) << s;
    }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, SecondDesign, ::testing::Range<std::size_t>(0, catalogue().size()),
                         [](const auto& one) { return std::string(catalogue()[one.param].id); });

}  // namespace
}  // namespace tunewright::product::second
