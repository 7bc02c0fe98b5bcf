// Every product of the catalogue compared with its published example, in the printed digits.
#include "engine/controller/product/to_controller.h"
#include "tests/engine/controller/product/support.h"

namespace tunewright::product {
namespace {

constexpr double kSixDigits = 5e-6;  // half a unit of the sixth digit, for a leading 1

class Examples : public ::testing::TestWithParam<std::size_t> {
protected:
    const Product& product = catalogue()[GetParam()];
    const Example& example = product.example;
};

void expect_value(const Product& product, const Setting& computed, const Value& printed) {
    const double* number = std::get_if<double>(&printed);
    if (!number) {
        EXPECT_EQ(computed.value, printed) << computed.name;
        return;
    }
    ASSERT_TRUE(std::holds_alternative<double>(computed.value)) << computed.name;
    double value = std::get<double>(computed.value);
    // A parameter with whole steps is printed as typed; PID_K1 is printed with four digits.
    const Parameter& parameter = *parameter_named(product, computed.name);
    if (parameter.resolution > 0) value = std::round(value / parameter.resolution) * parameter.resolution;
    EXPECT_TRUE(to_digits(value, *number, parameter.shape == Shape::lag_per_sample ? 5e-5 : kSixDigits))
        << computed.name;
}

TEST_P(Examples, DesignGivesThePrintedSettings) {
    const auto converted = to_settings(product, example.design, context_of(example), false);
    ASSERT_TRUE(converted) << converted.error().message;
    ASSERT_EQ(converted->settings.size(), example.settings.size());
    for (std::size_t i = 0; i < example.settings.size(); ++i) {
        EXPECT_EQ(converted->settings[i].name, example.settings[i].name);
        expect_value(product, converted->settings[i], example.settings[i].value);
    }
}

TEST_P(Examples, SettingsGiveTheControllerAndBackTheSettings) {
    const auto forward = to_settings(product, example.design, context_of(example), false);
    ASSERT_TRUE(forward) << forward.error().message;
    std::vector<Note> notes;
    const auto twin = to_controller(product, forward->settings, context_of(example), notes);
    ASSERT_TRUE(twin) << twin.error().message;
    EXPECT_TRUE(to_digits(twin->Kp, example.design.Kp, 1e-12));
    if (product.form != Form::p_only) {
        EXPECT_TRUE(to_digits(twin->Ti, example.design.Ti, 1e-12));
        EXPECT_TRUE(to_digits(twin->Td, example.design.Td, 1e-12));
    }
    const auto again = to_settings(product, *twin, context_of(example), false);
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(again->settings.size(), forward->settings.size());
    for (std::size_t i = 0; i < forward->settings.size(); ++i) {
        const double* number = std::get_if<double>(&forward->settings[i].value);
        if (!number) continue;
        // A parameter of the filter has its default if the block's ideal form has no filter.
        EXPECT_TRUE(to_digits(*number, std::get<double>(again->settings[i].value), 1e-9)) << forward->settings[i].name;
    }
}

TEST_P(Examples, EveryTextIsThere) {
    EXPECT_FALSE(product.id.empty() || product.maker.empty() || product.name.empty() || product.law.empty());
    EXPECT_FALSE(product.gain_basis.empty() || product.parameters.empty());
    for (const Parameter& parameter : product.parameters) {
        EXPECT_FALSE(parameter.label.empty());
        EXPECT_TRUE(parameter.elsewhere || !formula_text(product, parameter).empty()) << parameter.name;
    }
    EXPECT_TRUE(product.evidence.level == EvidenceLevel::read || !product.evidence.unverified.empty());
    EXPECT_NE(parameter_of(product, ParameterRole::gain), nullptr);
    EXPECT_EQ(find(product.id), &product);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Examples, ::testing::Range<std::size_t>(0, catalogue().size()),
                         [](const auto& one) { return std::string(catalogue()[one.param].id); });

}  // namespace
}  // namespace tunewright::product
