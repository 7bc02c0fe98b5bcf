// Behaviour of a block that its settings alone do not show: each is reported, or prevented.
#include <gmock/gmock.h>

#include <limits>
#include <stdexcept>

#include "engine/controller/product/notes.h"
#include "engine/controller/product/to_controller.h"
#include "engine/controller/schedule/schedule.h"
#include "tests/engine/controller/product/support.h"

namespace tunewright::product {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kNoIntegral = std::numeric_limits<double>::infinity();

Converted typed(std::string_view id, const IdealPid& pid, const Context& context = kContext, bool near = false) {
    auto answer = to_settings(product_of(id), pid, context, near);
    if (!answer) throw std::runtime_error(answer.error().message);
    return *answer;
}

std::vector<Note> notes_of(std::string_view id, const Settings& settings) {
    std::vector<Note> notes;
    EXPECT_TRUE(to_controller(product_of(id), settings, kContext, notes));
    return notes;
}

TEST(ProductTraps, BackCalculationOfAPIHasItsIntegralTime) {
    // The library divides by Tt: with 0 its integral would be infinite in the first call.
    const IdealPid PI{.Kp = 1.5, .Ti = 120};
    EXPECT_EQ(number(typed("discretepids_jl", PI).settings, "Tt"), 120);
    EXPECT_NEAR(number(typed("discretepids_jl", kDesign).settings, "Tt"), std::sqrt(120.0 * 20), 1e-12);
}

TEST(ProductTraps, NotesOnHowSettingsWereComputedAreToldFromWhatTheProductCannotBe) {
    for (const char* code : {"action", "clock", "default", "discretisation", "outside-the-twin", "unverified"})
        EXPECT_FALSE(is_deviation({code, ""})) << code;
    for (const char* code : {"filter", "setpoint-weights", "rounding", "nearest", "limit", "a-code-of-tomorrow"})
        EXPECT_TRUE(is_deviation({code, ""})) << code;
}

TEST(ProductTraps, WithoutIntegralActionItsTimeIsNought) {
    const IdealPid P{.Kp = 1.5, .Ti = kNoIntegral};
    EXPECT_EQ(number(typed("discretepids_jl", P).settings, "Ti"), 0);
    std::vector<Note> notes;
    const auto twin = to_controller(product_of("discretepids_jl"), {{"K", 1.5}, {"Ti", 0.0}}, kContext, notes);
    ASSERT_TRUE(twin);
    EXPECT_FALSE(twin->has_integral());
}

TEST(ProductTraps, TheSlowestIntegralIsSlowInSeconds) {
    const Converted beckhoff = typed("beckhoff_fb_ctrl_pid", {.Kp = 15, .Ti = kNoIntegral}, kContext, true);
    EXPECT_GE(beckhoff.realised.Ti, 0.99e6);
    EXPECT_THAT(note(beckhoff.notes, "nearest"), HasSubstr("an integral time of 1e+06"));
}

TEST(ProductTraps, AForwardFilterThatIsTooShortIsTold) {
    Context slow = kContext;
    slow.sample_time_s = 0.5;
    IdealPid pid = kDesign;
    pid.filter = {FilterType::derivative, 0.2};
    EXPECT_THAT(note(typed("simulink_pid_parallel", pid, slow).notes, "unstable-filter"),
                HasSubstr("unstable with Tf = 0.2 at a sample time of 0.5"));
    slow.sample_time_s = 0.1;
    EXPECT_FALSE(has_note(typed("simulink_pid_parallel", pid, slow).notes, "unstable-filter"));
}

TEST(ProductTraps, AFilterThatIsCompiledInIsToldWhereItIsAnother) {
    EXPECT_THAT(note(typed("marlin", kDesign).notes, "compiled-in"), HasSubstr("0.95 in the published firmware"));
    IdealPid stock = kDesign;
    stock.filter.Tf = *compiled_filter_time(product_of("marlin"), kContext);
    EXPECT_NEAR(stock.filter.Tf, 19 * 0.1638, 1e-9);
    EXPECT_FALSE(has_note(typed("marlin", stock).notes, "compiled-in"));
    EXPECT_FALSE(compiled_filter_time(product_of("klipper"), kContext));
}

TEST(ProductTraps, SettingsThatSwitchTheIntegralOffAreTold) {
    EXPECT_THAT(note(notes_of("ros_control_toolbox", {{"p", 1.5}, {"i", 0.0125}, {"d", 30.0}, {"i_clamp", 0.0}}),
                     "integral-off"),
                HasSubstr("there is no integral action"));
    EXPECT_THAT(note(notes_of("ros_control_toolbox", {{"p", 1.5}}), "integral-off"),
                HasSubstr("i is not given and its default is unknown"));
}

TEST(ProductTraps, PercentOfAnOutputThatIsNoneAreTold) {
    EXPECT_THAT(note(typed("siemens_pid_compact", kDesign, context_b()).notes, "percent"),
                HasSubstr("enter Gain times 6.25"));
    EXPECT_FALSE(has_note(typed("siemens_pid_compact", kDesign).notes, "percent"));
}

TEST(ProductTraps, NoPrefilterWithoutIntegralOrBesideAnotherFilter) {
    EXPECT_THAT(setpoint_prefilter({.Kp = 1, .Ti = 120, .b = 0.5}, {.Kp = 1, .Ti = kNoIntegral, .b = 1}), IsEmpty());
    IdealPid asked = kDesign, block = kDesign;
    asked.c = block.c = 1;
    block.b = 1;
    EXPECT_THAT(setpoint_prefilter(asked, block), HasSubstr("/"));
    block.filter.Tf = 0.1;
    EXPECT_THAT(setpoint_prefilter(asked, block), IsEmpty());
}

TEST(ProductTraps, WhatAScheduleDoesNotSwitchIsTold) {
    Schedule schedule{.interpolation = Interpolation::steps, .hysteresis = 0, .rows = {}};
    schedule.rows = {{.at = 0, .Kp = 1.5, .Ti = 120, .Td = 20, .Tf = 2, .b = 1},
                     {.at = 50, .Kp = 3, .Ti = 60, .Td = 10, .Tf = 4, .b = 0.2}};
    const auto notes = [&] {
        return to_settings(product_of("emerson_deltav_standard"), schedule, kContext, false)->notes;
    };
    EXPECT_THAT(note(notes(), "held-between-rows"), HasSubstr("The rows differ in ALPHA, STRUCTURE, which"));
    schedule.rows[1].Tf = 1;  // the same ratio
    schedule.rows[1].b = 1;
    EXPECT_FALSE(has_note(notes(), "held-between-rows"));
}

}  // namespace
}  // namespace tunewright::product
