// Plants as typed: every spelling of one plant gives that plant, ambiguous texts are refused, and every linear plant's
// text is read back as it.
#include "engine/plant/typed/typed_plant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/engine/plant/random_plants.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;
using testing::HasSubstr;

std::string fault(const std::string& text, double unit = 1) {
    const auto read = read_plant(text, unit);
    return read ? "no fault; read as " + plant_text(read->plant) : read.error().message;
}

/// The plant's own text: equal texts mean equal plants, to all digits.
std::string read_as(const std::string& text, double unit = 1) {
    const auto read = read_plant(text, unit);
    return read ? plant_text(read->plant) : "refused: " + read.error().message;
}

TEST(TypedPlant, SpellingsOfOnePlantAreThatPlant) {
    const std::string first = plant_text(Fopdt{.K = 2, .T = 10, .L = 3});
    EXPECT_EQ(first, "2 e^(-3 s)/(10 s + 1)");
    for (const char* text : {"2 e^(-3s)/(10s+1)",
                             "2e^(-3s)/(10s+1)",
                             "2*exp(-3*s)/(10*s+1)",
                             "2 exp(-3 s)/(1 + 10 s)",
                             "2e^-3s/(10s+1)",
                             "P(s) = 2 e^(-3s)/(10s+1)",
                             "G=2e^{-3s}/{10s+1}",
                             "2/(10s+1) e^(-3s)",
                             "2/(10s+1)*e^(-3s)",
                             "e^(-3s)*2/(10s+1)",
                             "4 e^(-3s)/(20s+2)",
                             "0.2e^(-3s)/(s+0.1)",
                             "2·e^(−3·s)/(10·s + 1)",
                             "2 × e⁻³ˢ/(10s+1)",
                             "2/(e^(3s)(10s+1))",
                             "K=2 T=10 L=3",
                             "K = 2, T = 10, L = 3",
                             "K: 2; tau: 10; theta: 3",
                             "Kp=2 τ=10 θ=3",
                             "k=2,t=10,l=3",
                             "gain 2, time constant 10, dead time 3",
                             "FOPDT 2 10 3",
                             "fopdt(2, 10, 3)",
                             "FOPDT K=2 T=10 L=3",
                             "tf([2],[10 1],'InputDelay',3)",
                             "tf(2, [10, 1], InputDelay=3)",
                             "control.tf([2],[10,1])*exp(-3*s)",
                             "s = tf('s'); 2*exp(-3*s)/(10*s+1)",
                             "zpk([], -0.1, 0.2, 'InputDelay', 3)",
                             "\\frac{2}{10s+1} e^{-3s}",
                             "tf([0 2],[10 1],\"InputDelay\",3)",
                             "2**1*exp(-3*s)/(10*s+1)**1",
                             "K=(2)/(10s+1)*e^(-3s)",
                             "K = 2 e^(-3s)/(10s+1)",
                             "K = 2/(10s+1)*e^(-3s)",
                             "G=(2 e^(-3s))/(10s+1)",
                             "\t2 e^(-3s) / (10s+1)\n"}) {
        EXPECT_EQ(read_as(text), first) << text;
    }
    const std::string second = plant_text(Sopdt{.K = 1.5, .T1 = 10, .T2 = 2, .L = 0.5});
    for (const char* text :
         {"1.5 e^(-0.5s)/((10s+1)(2s+1))", "1,5 e^(-0,5s)/((2s+1)(10s+1))", "1.5e^(-s/2)/(20s^2+12s+1)",
          "1.5 e^(-0.5s)/(20s²+12s+1)", "3 e^(-0.5s)/[2(10s+1)(2s+1)]", "sopdt 1.5 10 2 0.5", "K=1,5 T1=10 T2=2 L=0,5",
          "tf(1.5,[20 12 1])*exp(-.5*s)", "1.5/(10s+1)*1/(2s+1)*e^(-0.5s)", "1.5 e^(-0.5 s)/(10s+1)/(2s+1)",
          "1.5 e^(-0.5s)(10s+1)^-1 (2s+1)⁻¹"}) {
        EXPECT_EQ(read_as(text), second) << text;
    }
}

TEST(TypedPlant, TheTypeFollowsFromTheForm) {
    EXPECT_EQ(read_as("2/s"), plant_text(Ipdt{.K = 2}));
    EXPECT_EQ(read_as("e^-2s/(s(5s+1))"), plant_text(Ipdt{.K = 1, .L = 2, .T = 5}));
    EXPECT_EQ(read_as("ipdt K=0.05 L=4"), plant_text(Ipdt{.K = 0.05, .L = 4}));
    EXPECT_EQ(read_as("integrating 0.05 4"), plant_text(Ipdt{.K = 0.05, .L = 4}));
    EXPECT_EQ(read_as("K=1 T=0.5 zeta=0.2 L=0.1"),
              plant_text(OscillatorySopdt{.K = 1, .T = 0.5, .zeta = 0.2, .L = 0.1}));
    EXPECT_EQ(read_as("K=1 ω₀=2 ζ=0.2 L=0.1"), plant_text(OscillatorySopdt{.K = 1, .T = 0.5, .zeta = 0.2, .L = 0.1}));
    EXPECT_EQ(read_as("e^(-0.1s)/(0.25s²+0.2s+1)"),
              plant_text(OscillatorySopdt{.K = 1, .T = 0.5, .zeta = 0.2, .L = 0.1}));
    EXPECT_EQ(read_as("-3/(1-20s)"), plant_text(Fopdt{.K = -3, .T = -20}));
    EXPECT_EQ(read_as("3/(20s-1)"), plant_text(Fopdt{.K = -3, .T = -20}));
    EXPECT_EQ(read_as("0.7 e^(-2s)"), plant_text(Fopdt{.K = 0.7, .T = 0, .L = 2}));
    EXPECT_EQ(read_as("(2s+1)/(s^3+3s^2+3s+1)"), plant_text(TransferFunction{.num = {2, 1}, .den = {1, 3, 3, 1}}));
    EXPECT_EQ(read_as("1/(s+1)^8"), plant_text(Zpk{.K = 1, .zeros = {}, .poles = std::vector<Complex>(8, -1)}));
    EXPECT_EQ(read_as("2/s²"), plant_text(TransferFunction{.num = {2}, .den = {1, 0, 0}}));
    EXPECT_EQ(read_as("1/(s+1) + 1/(s+1)"), plant_text(Fopdt{.K = 2, .T = 1}));
    const std::string listed = plant_text(Zpk{.K = 5, .zeros = {-1}, .poles = {-2, {-3, 4}, {-3, -4}}, .L = 0.5});
    for (const char* text :
         {"zeros -1, poles -2 -3±4i, gain 5, delay 0.5", "zeros: -1; poles: -2, -3+4i, -3-4i; gain 5; delay .5",
          "z=[-1] p=[-2 -3+4j -3-4j] k=5 L=0.5", "poles -2 -3+-4i zeros -1 gain 5 dead time 0.5",
          "gain 5, zero -1, poles -2, -3 ± 4j, L=0.5"})
        EXPECT_EQ(read_as(text), listed) << text;
}

TEST(TypedPlant, UnitsOfTimeBecomeTheRequestsOwn) {
    EXPECT_EQ(read_as("K=2 T=10 min L=30 s"), "2 e^(-30 s)/(600 s + 1)");
    EXPECT_EQ(read_as("K=2 T=10 min L=30 s", 60), "2 e^(-0.5 s)/(10 s + 1)");
    EXPECT_EQ(read_as("K=2 T=1500ms L=500 ms"), "2 e^(-0.5 s)/(1.5 s + 1)");
    EXPECT_EQ(read_as("2 e^(-3 min s)/(0.5 h s + 1)", 60), "2 e^(-3 s)/(30 s + 1)");
    EXPECT_EQ(read_as("1/(4 min^2 s^2 + 1 min s + 1)", 60), read_as("1/(4s^2+s+1)"));
    EXPECT_EQ(read_as("ipdt K=0.6/min L=30 s"), "0.01 e^(-30 s)/s");
    EXPECT_EQ(read_as("FOPDT 2 10 min 3 min", 60), "2 e^(-3 s)/(10 s + 1)");
    EXPECT_THAT(fault("K=2 T=10 L=3 min"), HasSubstr("L has a unit of time and T has none"));
    EXPECT_THAT(fault("ipdt K=0.6 L=30 s"), HasSubstr("K=0.05/min"));
    EXPECT_THAT(fault("K=2 T=10 min L=30 s", 0), HasSubstr("units.time"));
    EXPECT_THAT(fault("2 min/(10s+1)"), HasSubstr("position 3: write a unit of time between its number and s"));
    EXPECT_THAT(fault("K=2 kPa T=3"), HasSubstr("units.u"));
}

TEST(TypedPlant, FaultsNamePlaceAndCure) {
    EXPECT_EQ(fault("2e^-3s/(10s+1"), "a bracket is not closed; it opens at position 8; close it.");
    EXPECT_EQ(fault("2/(10s+1))"), "position 10: this closing bracket has no opening one.");
    EXPECT_EQ(fault("2/(10s+)"), "position 8: \")\" stands where a number, s or a bracket belongs.");
    EXPECT_EQ(fault("2e^(−3s)/(10t+1)"),
              "position 13: \"t\" is unknown; a formula has numbers, s and e^(-3s). Write its value instead.");
    EXPECT_EQ(fault("2 €/(10s+1)").substr(0, 16), "position 3: \"\u20AC");
    EXPECT_THAT(fault(""), HasSubstr("the text is empty"));
    EXPECT_THAT(fault("2/"), HasSubstr("the text ends where"));
    EXPECT_THAT(fault("s^2/(s+1)"), HasSubstr("would be improper"));
    EXPECT_THAT(fault("2 e^(3s)/(10s+1)"), HasSubstr("not causal"));
    EXPECT_THAT(fault("1/(s+1) + e^(-s)/(s+2)"), HasSubstr("different dead times"));
    EXPECT_THAT(fault("e^(-s^2)/(s+1)"), HasSubstr("only a dead time"));
    EXPECT_THAT(fault("2 e^-3/(10s+1)"), HasSubstr("the exponent has no s"));
    EXPECT_THAT(fault("1/s^0.5"), HasSubstr("a power must be a whole number"));
    EXPECT_THAT(fault("1/((s+1)^30 (s+2)^21)"), HasSubstr("above 50"));
    EXPECT_THAT(fault("((s+1)^50)^50/s"), HasSubstr("above 50"));
    EXPECT_THAT(fault("(s-s)/(s+1)"), HasSubstr("the formula is 0"));
    EXPECT_THAT(fault("1/(s-s)"), HasSubstr("divides by 0"));
    EXPECT_THAT(fault("K=2 T=10 T=3"), HasSubstr("T is given twice"));
    EXPECT_THAT(fault("K=2 L=3"), HasSubstr("T is missing"));
    EXPECT_THAT(fault("K=2 T=10 X=3"), HasSubstr("\"X\" is not a parameter of a plant; known are K, T"));
    EXPECT_THAT(fault("poles -1+2i, gain 3"), HasSubstr("conjugate"));
    EXPECT_THAT(fault("tf([1],[1 1],0.1)"), HasSubstr("sample time"));
    EXPECT_THAT(fault("K=2 T=10 L=-3"), HasSubstr("L"));
    EXPECT_THAT(fault(std::string(2001, '1')), HasSubstr("at most 2000"));
    EXPECT_THAT(fault(std::string(500, '(') + "1"), HasSubstr("30 deep"));
    EXPECT_THAT(fault("1e300*1e300/(s+1)"), HasSubstr("too large"));
    EXPECT_THAT(fault("1e999/(s+1)"), HasSubstr("out of the number range"));
}

TEST(TypedPlant, WhatMayMeanTwoThingsIsRefused) {
    EXPECT_THAT(fault("1/2s"), HasSubstr("a/(b c) or (a/b) c"));
    EXPECT_THAT(fault("2/10s+1"), HasSubstr("a/(b c) or (a/b) c"));
    EXPECT_THAT(fault("1/(s+1)(s+2)"), HasSubstr("a/(b c) or (a/b) c"));
    EXPECT_THAT(fault("2e-3s/(10s+1)"), HasSubstr("2e-3s may be 0.002 s or 2 e^(-3 s)"));
    EXPECT_THAT(fault("poles -1,2 -3, gain 2"), HasSubstr("may be one number or two"));
    EXPECT_THAT(fault("FOPDT 2,10,3"), HasSubstr("may be one number or two"));
    EXPECT_THAT(fault("1,000 e^(-3s)/(10s+1)"), HasSubstr("1,000 may be 1.000 or 1000"));
    EXPECT_EQ(read_as("0,125/(10s+1)"), read_as("0.125/(10s+1)"));
}

TEST(TypedPlant, EveryPlantsTextIsReadBackAsIt) {
    RandomPlants plants;
    int same_type = 0, tried = 0;
    for (int i = 0; i < 5000; ++i) {
        const Plant plant = plants.next();
        if (!LinearPlant::make(plant)) continue;
        ++tried;
        const std::string text = plant_text(plant);
        const auto back = read_plant(text);
        ASSERT_TRUE(back) << text << "\n" << back.error().message;
        EXPECT_LT(distance(plant, back->plant), 1e-9) << text << "\n" << plant_text(back->plant);
        // A text that is read is written unchanged, except for the order of two lags and for gains inside a fraction.
        same_type += plant_text(back->plant) == text;
        // The displayed formula represents the same plant.
        if (std::holds_alternative<StateSpace>(plant)) continue;
        ASSERT_TRUE(back->formula) << text;
        const auto shown = typed::plant_of(*back->formula);
        ASSERT_TRUE(shown) << text;
        EXPECT_LT(distance(plant, *shown), 1e-6) << text;
    }
    EXPECT_GT(tried, 4000);
    EXPECT_GT(same_type, tried * 3 / 4);
}

// Pieces of the grammar in any order: a valid plant, or a printable fault.
TEST(TypedPlant, AnyTextIsReadOrRefused) {
    constexpr const char* kPieces[] = {"2",
                                       "s",
                                       "(",
                                       ")",
                                       "[",
                                       "]",
                                       "+",
                                       "-",
                                       "*",
                                       "/",
                                       "^",
                                       "e^",
                                       "exp(",
                                       "10",
                                       ",",
                                       ";",
                                       "=",
                                       "K",
                                       "T",
                                       "L=3",
                                       "zeta",
                                       "±",
                                       "i",
                                       "min",
                                       " ",
                                       "poles ",
                                       "²",
                                       "tf(",
                                       "zpk(",
                                       "'x'",
                                       "zeros",
                                       "\xC3",
                                       "\\frac{",
                                       "}",
                                       "1e",
                                       "e5",
                                       "0",
                                       ".",
                                       "InputDelay",
                                       "µs",
                                       "2,5",
                                       "s+1",
                                       "fopdt",
                                       "w0=",
                                       "gain ",
                                       "\n",
                                       "ss(",
                                       "{",
                                       "'",
                                       "# ",
                                       "a.y",
                                       "G = ",
                                       "delay(",
                                       "connect(",
                                       "conv(",
                                       "4im",
                                       "%",
                                       "s = tf('s');",
                                       "FirstOrder p(k=2,T=3);",
                                       "equation",
                                       "Inf",
                                       "dt=",
                                       "import x"};
    std::mt19937 random(7);
    std::uniform_int_distribution<std::size_t> piece(0, std::size(kPieces) - 1), length(1, 14);
    int plants = 0;
    for (int i = 0; i < 200000; ++i) {
        std::string text;
        for (std::size_t n = length(random); n > 0; --n) text += kPieces[piece(random)];
        SCOPED_TRACE(text);
        const auto read = read_plant(text);
        if (!read) {
            ASSERT_FALSE(read.error().message.empty()) << text;
            continue;
        }
        ++plants;
        ASSERT_TRUE(read_plant(plant_text(read->plant))) << text << " -> " << plant_text(read->plant);
    }
    EXPECT_GT(plants, 100);
}

}  // namespace
}  // namespace tunewright
