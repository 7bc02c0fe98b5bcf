// Choices that determine a block's weights and actions are typed too: form, structure, equation, switches. A design
// typed into a block with other previous settings gives the same loop.
#include "engine/controller/product/to_controller.h"
#include "engine/controller/product/typed.h"
#include "tests/engine/controller/product/support.h"

namespace tunewright::product {
namespace {

/// Weights of each kind that a structure may fix, and one in between; with and without a derivative.
std::vector<IdealPid> designs() {
    std::vector<IdealPid> all;
    for (const double Td : {0.0, 20.0}) {
        for (const double b : {0.0, 0.25, 0.6, 1.0}) {
            for (const double c : {0.0, 0.5, 1.0}) {
                const Filter filter = Td > 0 ? Filter{FilterType::derivative, 2} : Filter{};
                all.push_back({.Kp = 1.5, .Ti = 120, .Td = Td, .b = b, .c = c, .filter = filter});
            }
        }
    }
    return all;
}

class Structures : public ::testing::TestWithParam<std::size_t> {
protected:
    const Product& product = catalogue()[GetParam()];
};

TEST_P(Structures, EveryChoiceIsAmongWhatIsTyped) {
    for (const IdealPid& design : designs()) {
        const auto converted = to_settings(product, design, kContext, true);
        ASSERT_TRUE(converted) << converted.error().message;
        for (const Parameter& parameter : product.parameters) {
            if (parameter.options.empty() && parameter.role != ParameterRole::fixed) continue;
            EXPECT_NE(named(converted->settings, parameter.name), "") << parameter.name;
        }
    }
}

TEST_P(Structures, AWeightIsTypedOnlyWhereItCounts) {
    for (const IdealPid& design : designs()) {
        const auto converted = to_settings(product, design, kContext, true);
        ASSERT_TRUE(converted) << converted.error().message;
        for (const Setting& setting : converted->settings) {
            const Parameter* parameter = parameter_named(product, setting.name);
            if (parameter == nullptr) continue;  // the switch of the direction
            if (parameter->role != ParameterRole::weight_b && parameter->role != ParameterRole::weight_c) continue;
            if (!depends_on_choice(product, *parameter)) continue;
            EXPECT_TRUE(counts(product, *parameter, converted->settings)) << setting.name;
        }
    }
}

/// The product with another default of every choice.
Product other_defaults(Product product) {
    for (Parameter& parameter : product.parameters) std::ranges::reverse(parameter.options);
    return product;
}

TEST_P(Structures, WhatIsTypedActsTheSameWhateverTheBlockStoodAtBefore) {
    const Product other = other_defaults(product);
    for (const IdealPid& design : designs()) {
        const auto converted = to_settings(product, design, kContext, true);
        ASSERT_TRUE(converted) << converted.error().message;
        std::vector<Note> notes;
        const auto here = to_controller(product, converted->settings, kContext, notes);
        const auto there = to_controller(other, converted->settings, kContext, notes);
        ASSERT_TRUE(here && there);
        EXPECT_EQ(*here, *there) << "b = " << design.b << ", c = " << design.c;
    }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Structures, ::testing::Range<std::size_t>(0, catalogue().size()),
                         [](const auto& one) { return std::string(catalogue()[one.param].id); });

TEST(ChosenStructure, WithFreeWeightsHasTheDesignsOwn) {
    int products = 0;
    for (const Product& product : catalogue()) {
        const bool free = std::ranges::any_of(product.parameters, [](const Parameter& parameter) {
            return std::ranges::any_of(parameter.options, &Option::free_weights);
        });
        products += free;
        for (const IdealPid& design : free ? designs() : std::vector<IdealPid>{}) {
            const auto converted = to_settings(product, design, kContext, false);
            ASSERT_TRUE(converted) << product.id << ": " << converted.error().message;
            EXPECT_EQ(converted->realised.b, design.b) << product.id;
            if (design.Td > 0) {
                EXPECT_EQ(converted->realised.c, design.c) << product.id;
            }
        }
    }
    EXPECT_GE(products, 3);
}

struct Chosen {
    const char* product;
    double b, c;
    const char *name, *value;
};

/// The signals of P and D in the makers' notation.
const Chosen kChosen[] = {
    {"emerson_deltav_standard", 1, 0, "STRUCTURE", "PI action on error, D action on PV"},
    {"emerson_deltav_standard", 1, 1, "STRUCTURE", "PID action on error"},
    {"emerson_deltav_standard", 0, 0, "STRUCTURE", "I action on error, PD action on PV"},
    {"emerson_deltav_standard", 0.6, 0, "STRUCTURE", "Two degrees of freedom controller"},
    {"emerson_deltav_standard", 0, 1, "STRUCTURE", "Two degrees of freedom controller"},
    {"emerson_deltav_series", 0, 0, "FORM", "Series"},
    {"honeywell_ideal", 1, 1, "equation", "A"},
    {"honeywell_ideal", 1, 0, "equation", "B"},
    {"honeywell_ideal", 0, 0, "equation", "C"},
    {"honeywell_interactive_b", 1, 1, "equation", "B"},
    {"yokogawa_centum_pid", 1, 1, "type", "PID"},
    {"yokogawa_centum_pid", 1, 0, "type", "PI-D"},
    {"yokogawa_centum_pid", 0, 0, "type", "I-PD"},
    {"yokogawa_ff_pid", 1, 0, "MODE", "Auto"},
    {"rockwell_pid_independent", 1, 1, "DOE", "1"},
    {"rockwell_pid_independent", 1, 0, "DOE", "0"},
    {"rockwell_pid_independent", 1, 0, "PE", "0"},
    {"rockwell_pid_dependent", 1, 0, "PE", "1"},
    {"rockwell_pide_dependent", 1, 0, "DependIndepend", "true"},
    {"rockwell_pide_independent", 0, 1, "PVEProportional", "true"},
    {"rockwell_pide_independent", 0, 1, "PVEDerivative", "false"},
    {"schneider_pidff_mixed", 1, 1, "pv_dev", "deviation"},
    {"schneider_pidff_parallel", 1, 0, "mix_par", "1"},
    {"siemens_fb41_cont_c", 1, 1, "D_SEL", "true"},
    {"abb_fc19", 0, 0, "S11", "integral only"},
    {"labview_pid", 1, 0, "VI", "PID.vi"},
    {"labview_pid", 0.6, 0, "VI", "PID Advanced.vi"},
    {"simulink_pid_parallel", 0.6, 0, "block", "PID Controller (2DOF)"},
    {"arduino_pid_v1", 1, 0, "POn", "P_ON_E"},
    {"simple_pid", 1, 1, "differential_on_measurement", "false"},
};

TEST(ChosenStructure, IsTheOneThatHasTheDesignsWeights) {
    for (const auto& [id, b, c, name, value] : kChosen) {
        IdealPid design = kDesign;
        design.b = b;
        design.c = c;
        const auto converted = to_settings(product_of(id), design, kContext, false);
        ASSERT_TRUE(converted) << id;
        EXPECT_EQ(named(converted->settings, name), value) << id << ": b = " << b << ", c = " << c;
    }
}

TEST(ChosenStructure, FixedWeightsAreNotTypedBesideIt) {
    IdealPid design = kDesign;
    design.b = 0;
    const auto converted = to_settings(product_of("emerson_deltav_standard"), design, kContext, false);
    ASSERT_TRUE(converted);
    EXPECT_EQ(named(converted->settings, "BETA"), "");
    EXPECT_EQ(named(converted->settings, "GAMMA"), "");
}

TEST(ChosenStructure, SwitchesOffWhatTheDesignHasNot) {
    const IdealPid PI{.Kp = 1.5, .Ti = 120}, PD{.Kp = 1.5, .Td = 20, .filter = {FilterType::derivative, 2}};
    const auto fb41_PI = to_settings(product_of("siemens_fb41_cont_c"), PI, kContext, false);
    ASSERT_TRUE(fb41_PI);
    EXPECT_EQ(named(fb41_PI->settings, "D_SEL"), "false");
    EXPECT_EQ(named(fb41_PI->settings, "I_SEL"), "true");
    const auto fb41_PD = to_settings(product_of("siemens_fb41_cont_c"), PD, kContext, false);
    ASSERT_TRUE(fb41_PD);
    EXPECT_EQ(named(fb41_PD->settings, "I_SEL"), "false");
    EXPECT_EQ(fb41_PD->realised.Td, 20);
    EXPECT_FALSE(fb41_PD->realised.has_integral());
    const auto deltav = to_settings(product_of("emerson_deltav_standard"), PD, kContext, false);
    ASSERT_TRUE(deltav) << deltav.error().message;
    EXPECT_EQ(named(deltav->settings, "STRUCTURE"), "P action on error, D action on PV");
    EXPECT_EQ(named(deltav->settings, "RESET"), "");
    EXPECT_FALSE(deltav->realised.has_integral());
}

TEST(ChosenStructure, OfTodaysSettingsIsReadOrSaidToBeAssumed) {
    const Product& deltav = product_of("emerson_deltav_standard");
    const Settings plain{{"GAIN", 3.0}, {"RESET", 120.0}, {"RATE", 20.0}};
    const auto read = [&](Settings settings, std::vector<Note>& notes) {
        settings.insert(settings.begin(), plain.begin(), plain.end());
        return *to_controller(deltav, settings, kContext, notes);
    };
    std::vector<Note> by_default, inferred, chosen, idle;
    EXPECT_EQ(read({}, by_default).b, 1);
    EXPECT_NE(note(by_default, "default").find("STRUCTURE = PI action on error, D action on PV"), std::string::npos);
    EXPECT_EQ(read({{"BETA", 0.4}}, inferred).b, 0.4);
    EXPECT_NE(note(inferred, "default").find("STRUCTURE = Two degrees of freedom controller"), std::string::npos);
    EXPECT_EQ(read({{"STRUCTURE", std::string("I action on error, PD action on PV")}}, chosen).b, 0);
    EXPECT_EQ(read({{"STRUCTURE", std::string("PID action on error")}, {"BETA", 0.4}}, idle).b, 1);
    EXPECT_NE(note(idle, "outside-the-twin").find("BETA is 0.4"), std::string::npos);
}

TEST(ChosenStructure, OfAnotherEntryIsRefused) {
    std::vector<Note> notes;
    const auto read =
        to_controller(product_of("emerson_deltav_series"),
                      {{"GAIN", 3.0}, {"RESET", 120.0}, {"FORM", std::string("Standard")}}, kContext, notes);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().where, "settings/FORM");
    EXPECT_NE(read.error().message.find("it must be Series"), std::string::npos);
}

}  // namespace
}  // namespace tunewright::product
