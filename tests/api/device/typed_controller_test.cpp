// Controllers as control software writes them: each text has the settings that its software reads in it, and every text
// that the catalogue writes is read back as the settings in it.
#include "api/contract/device/typed_controller.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <random>
#include <string>

#include "engine/controller/product/catalogue.h"
#include "engine/controller/product/snippet.h"
#include "engine/controller/product/to_controller.h"

namespace tunewright::api {
namespace {

using testing::HasSubstr;

std::string fault_of_text(const std::string& text) {
    const auto read = read_controller(text);
    return read ? "no fault; read as " + read->product : read.error().message;
}

/// The controller of a text, in seconds.
IdealPid pid_of(const std::string& text, const std::string& product) {
    const auto read = read_controller(text);
    EXPECT_TRUE(read) << text << "\n" << (read ? "" : read.error().message);
    if (!read) return {};
    EXPECT_EQ(read->product, product) << text;
    std::vector<product::Note> notes;
    const auto pid = product::to_controller(*product::find(read->product), read->settings, {}, notes);
    EXPECT_TRUE(pid) << text << "\n" << (pid ? "" : pid.error().message);
    return pid ? *pid : IdealPid{};
}

void expect_pid(const std::string& text, const std::string& product, const IdealPid& wanted) {
    SCOPED_TRACE(text);
    const IdealPid pid = pid_of(text, product);
    EXPECT_DOUBLE_EQ(pid.Kp, wanted.Kp);
    EXPECT_DOUBLE_EQ(pid.Ti, wanted.Ti);
    EXPECT_DOUBLE_EQ(pid.Td, wanted.Td);
    EXPECT_DOUBLE_EQ(pid.b, wanted.b);
    EXPECT_DOUBLE_EQ(pid.c, wanted.c);
    EXPECT_EQ(pid.filter.type, wanted.filter.type);
    EXPECT_DOUBLE_EQ(pid.filter.Tf, wanted.filter.Tf);
}

constexpr IdealPid kFull{.Kp = 1.5, .Ti = 120, .Td = 20, .b = 1, .c = 1, .filter = {FilterType::derivative, 2}};

TEST(TypedController, TheCallOfEverySoftwareHasItsOwnMeaning) {
    expect_pid("pidstd(1.5, 120, 20, 10)", "matlab_pidstd", kFull);
    expect_pid("C = pidstd(1.5,120,20,10);", "matlab_pidstd", kFull);
    expect_pid("pid(1.5, 0.0125, 30, 2)", "matlab_pid", kFull);
    expect_pid("Kp = 1.5; Ti = 120; C = pid(Kp, Kp/Ti, Kp*20, 2);", "matlab_pid", kFull);
    IdealPid weighted = kFull;
    weighted.b = 0.6;
    weighted.c = 0;
    expect_pid("C2 = pidstd2(1.5, 120, 20, 10, 0.6, 0)", "matlab_pidstd2", weighted);
    expect_pid("pid2(1.5, 0.0125, 30, 2, 0.6, 0)", "matlab_pid2", weighted);
    expect_pid("using ControlSystemsBase\n\nC = pid(1.5, 120, 20; form = :standard, Tf = 2, filter_order = 1)",
               "controlsystems_jl_pid", kFull);
    expect_pid("DiscretePID(; K = 1.5, Ti = 120, Td = 20, N = 10, wp = 0.6, wd = 0, Tt = 49, Ts = 0.25, umax = 5)",
               "discretepids_jl", weighted);
    expect_pid(
        "Modelica.Blocks.Continuous.LimPID c(controllerType=Modelica.Blocks.Types.SimpleController.PID, k=1.5, "
        "Ti=120, Td=20, Nd=10, wp=0.6, yMax=100);",
        "modelica_limpid", weighted);
    expect_pid("LimPID(k=1.5, Ti=120, Td=20, wp=0.6)", "modelica_limpid", weighted);
}

TEST(TypedController, ActionsMayBeMissing) {
    IdealPid pi{.Kp = 1.5, .Ti = 120, .Td = 0, .b = 1, .c = 1};
    expect_pid("pidstd(1.5, 120)", "matlab_pidstd", pi);
    expect_pid("pidstd(1.5, 120, 0, Inf)", "matlab_pidstd", pi);
    expect_pid("pid(1.5, 0.0125, 0, 0)", "matlab_pid", pi);
    IdealPid p{.Kp = 1.5, .b = 1, .c = 1};
    expect_pid("pidstd(1.5, Inf)", "matlab_pidstd", p);
    expect_pid("pid(1.5)", "matlab_pid", p);
    pi.c = 0;
    expect_pid("LimPID(controllerType=Modelica.Blocks.Types.SimpleController.PI, k=1.5, Ti=120)", "modelica_limpid",
               pi);
    // Modelica's own defaults, Ti 0.5 s and Td 0.1 s.
    const IdealPid defaults{.Kp = 2, .Ti = 0.5, .Td = 0.1, .b = 1, .c = 0, .filter = {FilterType::derivative, 0.01}};
    expect_pid("LimPID(k=2)", "modelica_limpid", defaults);
}

void expect_near(const std::string& text, const IdealPid& wanted) {
    SCOPED_TRACE(text);
    const IdealPid pid = pid_of(text, "python_control");
    EXPECT_NEAR(pid.Kp, wanted.Kp, 1e-13 * std::abs(wanted.Kp));
    if (wanted.has_integral())
        EXPECT_NEAR(pid.Ti, wanted.Ti, 1e-13 * wanted.Ti);
    else
        EXPECT_FALSE(pid.has_integral());
    EXPECT_NEAR(pid.Td, wanted.Td, 1e-13 * wanted.Td);
    EXPECT_NEAR(pid.filter.Tf, wanted.filter.Tf, 1e-13 * wanted.filter.Tf);
}

TEST(TypedController, ATransferFunctionOfPidFormIsOne) {
    for (const char* text :
         {"import control as ct\n\ns = ct.tf('s')\nC = 1.5 + 0.0125/s + 30*s/(2*s + 1)",
          "pkg load control\n\ns = tf(\"s\");\nC = 1.5 + 0.0125/s + 30*s/(2*s + 1);", "tf([33 1.525 0.0125],[2 1 0])",
          "1.5 (1 + 1/(120s) + 20s/(2s+1))", "C = tf([66 3.05 0.025],[4 2 0])"})
        expect_near(text, kFull);
    expect_near("1.5 + 0.0125/s", {.Kp = 1.5, .Ti = 120});
    expect_near("1.5 (120s + 1)/(120 s)", {.Kp = 1.5, .Ti = 120});
    expect_near("-4", {.Kp = -4});
    expect_near("C = 2.5 + 0/s + 1.875*s/(0.25*s + 1)",
                {.Kp = 2.5, .Td = 0.75, .filter = {FilterType::derivative, 0.25}});
    expect_near("tf([30 1.5 0.0125],[1 0])", {.Kp = 1.5, .Ti = 120, .Td = 20});
}

TEST(TypedController, WhatIsNoControllerIsRefusedWithTheCure) {
    EXPECT_THAT(fault_of_text("pid(1.5, 0.0125, 30)"), HasSubstr("may be of MATLAB pid"));
    EXPECT_THAT(fault_of_text("pid(1.5, 0.0125)"), HasSubstr("pid(Kp, Ti, Td; form=:standard) for the second"));
    EXPECT_THAT(fault_of_text("pid(1,2,3,4,0.1)"), HasSubstr("position 13: another argument would be a sample time"));
    EXPECT_THAT(fault_of_text("pidstd()"), HasSubstr("arguments are missing; write pidstd(Kp, Ti, Td, N)"));
    EXPECT_THAT(fault_of_text("pidstd(1,2,'Ts',0.1)"), HasSubstr("\"Ts\" is not a setting of MATLAB pidstd"));
    EXPECT_THAT(fault_of_text("pidstd(Kp,2)"), HasSubstr("\"Kp\""));
    EXPECT_THAT(fault_of_text("LimPID(1.5, 120)"), HasSubstr("name the arguments of LimPID"));
    EXPECT_THAT(fault_of_text("LimPID(k=1, Nd=Inf)"), HasSubstr("Nd is infinite"));
    EXPECT_THAT(fault_of_text("pidstd(1,2) + 3"), HasSubstr("belongs"));
    EXPECT_THAT(fault_of_text("1.5 e^(-s) + 1/s"), HasSubstr("dead time"));
    EXPECT_THAT(fault_of_text("1.5 e^(-s)"), HasSubstr("dead time, which a PID controller has not"));
    EXPECT_THAT(fault_of_text("1/s^2"), HasSubstr("is not a PID controller"));
    EXPECT_THAT(fault_of_text("(s+1)^3/s"), HasSubstr("is not a PID controller"));
    EXPECT_THAT(fault_of_text("(s+1)/(s(1 - 2s))"), HasSubstr("negative time"));
    EXPECT_THAT(fault_of_text(""), HasSubstr("the text is empty; write a controller"));
    EXPECT_THAT(fault_of_text("ss(-1,1,1,0)"), HasSubstr("not a state space"));
}

TEST(TypedController, EveryTextOfTheCatalogueIsReadBackAsItsSettings) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> decade(-2, 3);
    std::bernoulli_distribution often(0.7);
    int texts = 0;
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
        IdealPid pid{.Kp = std::pow(10, decade(random)), .Ti = std::pow(10, decade(random)), .b = 0.5, .c = 0};
        if (often(random)) pid.Td = pid.Ti / 4, pid.filter = {FilterType::derivative, pid.Td / 8};
        std::vector<std::string> ids{"python_control", "octave_control"};
        for (const product::Constructor& constructor : product::constructors()) ids.emplace_back(constructor.product);
        for (const std::string& id : ids) {
            const product::Product& product = *product::find(id);
            const auto context = product::Context{.sample_time_s = 0.25};
            const auto converted = product::to_settings(product, pid, context, true);
            ASSERT_TRUE(converted) << id;
            const auto snippets = product::filled_snippets(product, as_typed(product, converted->settings), context);
            ASSERT_EQ(snippets.size(), 1u);
            SCOPED_TRACE(snippets[0].text);
            const auto read = read_controller(snippets[0].text);
            ASSERT_TRUE(read) << read.error().message;
            EXPECT_EQ(read->product, id == "octave_control" ? "python_control" : id);
            std::vector<product::Note> notes;
            const auto back = product::to_controller(*product::find(read->product), read->settings, context, notes);
            ASSERT_TRUE(back) << back.error().message;
            // The settings that were read make the same text again: nothing was lost on the way.
            const auto again = product::filled_snippets(product, read->settings, context);
            if (read->product == id && id != "python_control") {
                EXPECT_EQ(again[0].text, snippets[0].text);
            }
            // A number is typed with four digits.
            for (const auto& [found, wanted] : {std::pair{back->Kp, pid.Kp},
                                                {back->Ti, pid.Ti},
                                                {back->Td, pid.Td},
                                                {back->filter.Tf, pid.filter.Tf}})
                if (wanted != 0) worst = std::max(worst, std::abs(found / wanted - 1));
            EXPECT_EQ(back->filter.type, pid.Td == 0 ? FilterType::none : FilterType::derivative);
            ++texts;
        }
    }
    std::printf("%d texts read back, the worst relative difference is %.2g\n", texts, worst);
    EXPECT_LT(worst, 5e-3);
}

// Pieces of the grammar in any order: settings that the product knows, or a printable fault.
TEST(TypedController, AnyTextIsReadOrRefused) {
    constexpr const char* kPieces[] = {"pid(", "pidstd(", "LimPID(", "DiscretePID(", "1.5",       ",",    ";", ")",
                                       "Inf",  "k=",      "Ti=",     "form=",        ":standard", "'Tf'", "=", "s",
                                       "/",    "+",       "tf(",     "[1 2]",        "C = ",      "\n",   "(", "*",
                                       "0",    "-",       "x",       "Kp",           "2",         " "};
    std::mt19937 random(11);
    std::uniform_int_distribution<std::size_t> piece(0, std::size(kPieces) - 1), length(1, 12);
    int controllers = 0;
    for (int i = 0; i < 100000; ++i) {
        std::string text;
        for (std::size_t n = length(random); n > 0; --n) text += kPieces[piece(random)];
        const auto read = read_controller(text);
        if (read) {
            ++controllers;
            ASSERT_NE(product::find(read->product), nullptr) << text;
        } else {
            ASSERT_FALSE(read.error().message.empty()) << text;
        }
    }
    EXPECT_GT(controllers, 100);
}

}  // namespace
}  // namespace tunewright::api
