// Settings that a block cannot represent are refused with a sentence; deviations are in notes.
#include <stdexcept>

#include <gmock/gmock.h>

#include "engine/controller/product/to_controller.h"
#include "tests/engine/controller/product/support.h"

namespace tunewright::product {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

Error refused(std::string_view id, const IdealPid& pid, const Context& context = kContext) {
    const auto answer = to_settings(product_of(id), pid, context, false);
    return answer ? Error{ErrorKind::numerical_failure, "", "not refused"} : answer.error();
}
Converted nearest(std::string_view id, const IdealPid& pid) {
    auto answer = to_settings(product_of(id), pid, kContext, true);
    if (!answer) throw std::runtime_error(answer.error().message);
    return *answer;
}
Error not_read(std::string_view id, const Settings& settings, const Context& context = kContext) {
    std::vector<Note> notes;
    const auto answer = to_controller(product_of(id), settings, context, notes);
    return answer ? Error{ErrorKind::numerical_failure, "", "not refused"} : answer.error();
}

TEST(ProductRefusals, ComplexZerosHaveNoSeriesForm) {
    IdealPid pid = kDesign;
    pid.Ti = 60;
    const Error error = refused("emerson_deltav_series", pid);
    EXPECT_EQ(error.kind, ErrorKind::not_representable);
    EXPECT_STREQ(to_string(error.kind), "not-representable");
    EXPECT_EQ(error.message,
              "DeltaV PID, FORM Series cannot represent this controller. Its form is a series, whose zeros are real: "
              "Ti = 60 is "
              "below 91.43, 4 Td/(1 - alpha) with alpha = 0.125. The nearest settings: both times sqrt(Ti Td) = 34.64 "
              "and a gain "
              "of 0.5774 Kp. They keep the integral gain; the proportional gain becomes 1.083 times and the derivative "
              "gain 0.7656 times the design's. A tuning for this block, under that limit, is better.");
    const Converted near = nearest("emerson_deltav_series", pid);
    EXPECT_NEAR(number(near.settings, "RESET"), std::sqrt(60.0 * 20), 1e-12);
    EXPECT_NEAR(number(near.settings, "RATE"), std::sqrt(60.0 * 20), 1e-12);
    EXPECT_NEAR(number(near.settings, "GAIN"), 3 * std::sqrt(20.0 / 60), 1e-12);
    EXPECT_TRUE(has_note(near.notes, "nearest"));
    EXPECT_NEAR(near.realised.Kp / near.realised.Ti, pid.Kp / pid.Ti, 1e-15);
    EXPECT_NEAR(near.realised.Kp / pid.Kp, 1.0825, 1e-4);
    EXPECT_NEAR(near.realised.Kp * near.realised.Td / (pid.Kp * pid.Td), 0.765625, 1e-12);
    // Without a filter in the lead the derivative gain is also kept, and P rises by 15.5 % at Ti = 3 Td.
    const Converted foxboro = nearest("foxboro_pid", pid);
    EXPECT_NEAR(foxboro.realised.Kp / pid.Kp, 2 / std::sqrt(3), 1e-12);
    EXPECT_NEAR(foxboro.realised.Kp * foxboro.realised.Td, pid.Kp * pid.Td, 1e-12);
    EXPECT_NEAR(foxboro.realised.filter.Tf, 2, 1e-12);
}

TEST(ProductRefusals, OnTheBorderOfRealZerosTheSeriesFormIsExact) {
    IdealPid pid = kDesign;
    pid.Ti = 80;
    const auto exact = to_settings(product_of("foxboro_pid"), pid, kContext, false);
    ASSERT_TRUE(exact) << exact.error().message;
    EXPECT_NEAR(exact->realised.Ti, 80, 1e-12);
    EXPECT_NEAR(exact->realised.Td, 20, 1e-12);
}

// 32 bits in milliseconds, with a sign at Siemens and without one at Beckhoff.
TEST(ProductRefusals, ATimeThatOverflowsItsTypeIsRefused) {
    struct Bound {
        const char* product;
        const char* gain;
        const char* time;
        double max_ms, per_ms;
        const char* range;
    };
    for (const Bound& bound : {Bound{"siemens_fb41_cont_c", "GAIN", "TI_s", 2147483647, 1e-3, "0.001 to 2147483.647 s"},
                               Bound{"beckhoff_fb_ctrl_pid", "fKp", "tTn_ms", 4294967295, 1, "1 to 4294967295 ms"}}) {
        SCOPED_TRACE(bound.product);
        IdealPid slow = kDesign;
        slow.Ti = bound.max_ms / 1000;
        const auto largest = to_settings(product_of(bound.product), slow, kContext, false);
        ASSERT_TRUE(largest) << largest.error().message;
        EXPECT_DOUBLE_EQ(number(largest->settings, bound.time), bound.max_ms * bound.per_ms);
        slow.Ti = (bound.max_ms + 1) / 1000;
        const Error error = refused(bound.product, slow);
        EXPECT_EQ(error.kind, ErrorKind::not_representable);
        EXPECT_THAT(error.message, HasSubstr(std::string("but it accepts ") + bound.range));
        EXPECT_DOUBLE_EQ(number(nearest(bound.product, slow).settings, bound.time), bound.max_ms * bound.per_ms);
        EXPECT_THAT(
            not_read(bound.product, {{bound.gain, 1.0}, {bound.time, (bound.max_ms + 1) * bound.per_ms}}).message,
            HasSubstr(std::string("it must be ") + bound.range));
    }
}

TEST(ProductRefusals, AValueOutsideItsRangeIsRefusedWithTheNearest) {
    IdealPid weak = kDesign;
    weak.Kp = 0.01;
    EXPECT_THAT(refused("yokogawa_centum_pid", weak).message,
                HasSubstr("PB would be 5000, but it accepts 0 to 1000 %. The nearest: PB = 1000."));
    EXPECT_NEAR(nearest("yokogawa_centum_pid", weak).realised.Kp, 0.05, 1e-15);
    IdealPid quick = kDesign;
    quick.Ti = 0.02;
    quick.Td = 0;
    quick.filter = {};
    // 0 would switch the integral off.
    EXPECT_THAT(refused("mitsubishi_fx_pid", quick).message,
                HasSubstr("TI would be 0.2, but it accepts 1 to 32767 100 ms"));
    EXPECT_NEAR(nearest("mitsubishi_fx_pid", quick).realised.Ti, 0.1, 1e-15);
}

TEST(ProductRefusals, NoIntegralActionNeedsAValueThatIsKnownToMeanIt) {
    IdealPid pd = kDesign;
    pd.Ti = kNever;
    EXPECT_THAT(refused("yokogawa_ff_pid", pd).message, HasSubstr("RESET has no known value that switches"));
    EXPECT_EQ(number(nearest("yokogawa_ff_pid", pd).settings, "RESET"), 10000);
}

TEST(ProductRefusals, AHeaterDoesNotCool) {
    IdealPid cooling = kDesign;
    cooling.Kp = -1.5;
    for (const char* id : {"marlin", "klipper", "esphome_pid", "betaflight"}) {
        EXPECT_EQ(refused(id, cooling).kind, ErrorKind::not_representable) << id;
        EXPECT_THAT(refused(id, cooling).message, HasSubstr("cannot be negative and it has no switch")) << id;
    }
    EXPECT_GT(nearest("klipper", cooling).realised.Kp, 0);
}

TEST(ProductRefusals, PureIntegralActionHasNoIdealForm) {
    IdealPid none = kDesign;
    none.Kp = 0;
    EXPECT_EQ(refused("simple_pid", none).kind, ErrorKind::not_representable);
    const Error error = not_read("simple_pid", {{"Kp", 0.0}, {"Ki", 0.1}});
    EXPECT_EQ(error.kind, ErrorKind::not_representable);
    EXPECT_EQ(error.where, "settings/Kp");
    EXPECT_EQ(not_read("simple_pid", {{"Kp", 1.0}, {"Ki", -0.1}}).where, "settings/Ki");
    EXPECT_EQ(not_read("simple_pid", {{"Kp", 1.0}, {"Kd", -0.1}}).where, "settings/Kd");
}

TEST(ProductRefusals, AThermostatOfPAloneIsConvertedAndSaysSo) {
    const Converted tpi = nearest("ha_versatile_thermostat_tpi", kDesign);
    EXPECT_FALSE(tpi.realised.has_integral());
    EXPECT_EQ(tpi.realised.Td, 0);
    EXPECT_THAT(note(tpi.notes, "proportional-only"), HasSubstr("another loop"));
}

TEST(ProductRefusals, MissingSpansAndSampleTimesAreNamedWithTheCure) {
    EXPECT_EQ(refused("emerson_deltav_standard", kDesign, {}).where, "y_span");
    EXPECT_EQ(
        refused("emerson_deltav_standard", kDesign, {}).message,
        "y_span is missing; GAIN of DeltaV PID, FORM Standard is Kp Sy/Su. Give the range of the measurement, such "
        "as \"y_span\": [0, 200].");
    const Context without_u{.spans = {0, 200, 0, 100}, .y_span_given = true};
    EXPECT_EQ(refused("emerson_deltav_standard", kDesign, without_u).where, "u_span");
    EXPECT_EQ(refused("klipper", kDesign, without_u).where, "u_span");
    EXPECT_EQ(not_read("klipper", {{"pid_Kp", 3.825}}, without_u).where, "u_span");
    const Context no_time = Context::with_spans({});
    for (const char* id : {"esphome_pid", "openplc_iec_pid", "mitsubishi_fx_pid", "discretepids_jl"}) {
        EXPECT_EQ(refused(id, kDesign, no_time).where, "sample_time") << id;
        EXPECT_EQ(refused(id, kDesign, no_time).kind, ErrorKind::invalid_argument) << id;
    }
    EXPECT_EQ(refused("klipper", kDesign, no_time).message, "not refused");
    EXPECT_EQ(refused("siemens_pid_compact", kDesign, {}).message, "not refused");
    // The period in the settings is sufficient to read them.
    std::vector<Note> notes;
    const auto twin =
        to_controller(product_of("openplc_iec_pid"), {{"KP", -1.5}, {"TD", 20.0}, {"CYCLE_s", 0.5}}, {}, notes);
    ASSERT_TRUE(twin) << twin.error().message;
    EXPECT_EQ(twin->filter.Tf, 0.5);
}

TEST(ProductRefusals, AnOptionalLimitIsLeftOutWithoutItsSpan) {
    const auto ros = to_settings(product_of("ros_control_toolbox"), kDesign, {}, false);
    ASSERT_TRUE(ros) << ros.error().message;
    EXPECT_EQ(named(ros->settings, "i_clamp"), "");
    EXPECT_THAT(note(ros->notes, "limit"), HasSubstr("It must be set"));
}

TEST(ProductRefusals, WrongSettingsSayWhatIsTaken) {
    EXPECT_EQ(not_read("simple_pid", {{"kp", 1.0}}).message,
              "kp of simple-pid (Python) is unknown. Its parameters are Kp, Ki, Kd, proportional_on_measurement, "
              "differential_on_measurement.");
    EXPECT_EQ(not_read("simple_pid", {{"Ki", 1.0}}).message, "Kp is missing; it is the gain of simple-pid (Python).");
    EXPECT_THAT(not_read("simple_pid", {{"Kp", std::string("2")}}).message, HasSubstr("it must be a number"));
    EXPECT_THAT(not_read("yokogawa_centum_pid", {{"PB", 2000.0}}).message,
                HasSubstr("PB of CENTUM CS 3000 / VP PID block is 2000; it must be 0 to 1000 %"));
    EXPECT_THAT(not_read("schneider_pidff_mixed", {{"kp", 1.0}, {"pv_dev", 1.0}}).message,
                HasSubstr("it must be PV or deviation"));
    EXPECT_THAT(not_read("omron_pid190", {{"P", 100.0}, {"alpha_code", std::string("65")}}).message,
                HasSubstr("\"100\" to \"199\""));
    EXPECT_THAT(not_read("siemens_pid_compact", {{"Gain", -1.0}}).message, HasSubstr("it must be at least 0"));
    EXPECT_EQ(not_read("siemens_pid_compact", {{"Gain", 1.0}, {"InvertControl", 3.0}}).where, "settings/InvertControl");
}

TEST(ProductRefusals, SettingsThatNoControllerOfTheContractIsAreRefused) {
    const Error silent = not_read("matlab_pidstd", {{"Kp", 1.0}, {"Td", 2.0}, {"N", 0.0}});
    EXPECT_EQ(silent.where, "settings/N");
    EXPECT_THAT(silent.message, HasSubstr("removes the derivative"));
    // Td = (1 - alpha) td (ti - alpha td)/Ti.
    const Error outlasted =
        not_read("emerson_deltav_series", {{"GAIN", 1.0}, {"RESET", 1.0}, {"RATE", 10.0}, {"ALPHA", 0.5}});
    EXPECT_EQ(outlasted.kind, ErrorKind::not_representable);
    EXPECT_THAT(outlasted.message, HasSubstr("Td -3.333"));
    const IdealPid huge{.Kp = 1e300, .Ti = 1, .b = 1};
    const Context wide = Context::with_spans({.y_low = 0, .y_high = 1e300, .u_low = 0, .u_high = 1}, 1.0);
    EXPECT_THAT(refused("emerson_deltav_standard", huge, wide).message, HasSubstr("out of the number range"));
}

TEST(ProductRefusals, MissingSettingsHaveTheMakersDefaults) {
    std::vector<Note> notes;
    const auto oscat = to_controller(product_of("oscat_ctrl_pid"), {{"KP", 2.0}}, {}, notes);
    ASSERT_TRUE(oscat);
    EXPECT_EQ(oscat->Ti, 1);
    EXPECT_EQ(oscat->Td, 1);
    EXPECT_EQ(note(notes, "default"), "Not given, so the maker's default: TN = 1, TV = 1.");
    const auto omron =
        to_controller(product_of("omron_pid190"),
                      {{"P", 333.0}, {"Tik_0_1s", 9999.0}, {"alpha_code", std::string("000")}}, kContext, notes);
    ASSERT_TRUE(omron);
    EXPECT_NEAR(omron->b, 0.35, 1e-15);
    EXPECT_FALSE(omron->has_integral());
}

TEST(ProductRefusals, WeightsAndChoicesThatAreTakenByDefaultAreToldToo) {
    const auto defaults = [](const char* product, const Settings& settings) {
        std::vector<Note> notes;
        EXPECT_TRUE(to_controller(product_of(product), settings, kContext, notes)) << product;
        return note(notes, "default");
    };
    EXPECT_EQ(defaults("omron_pid190", {{"P", 333.0}, {"Tik_0_1s", 1200.0}, {"Tdk_0_1s", 0.0}}),
              "Not given, so the maker's default: alpha_code = 000.");
    EXPECT_EQ(defaults("yokogawa_ff_pid", {{"GAIN", 2.0}, {"RESET", 60.0}, {"RATE", 0.0}}),
              "Not given, so the maker's default: MODE = Auto.");
    EXPECT_EQ(defaults("omron_pid190",
                       {{"P", 333.0}, {"Tik_0_1s", 1200.0}, {"Tdk_0_1s", 0.0}, {"alpha_code", std::string("140")}}),
              "");
}

TEST(ProductRefusals, WordsOfSixteenBitsEndAt32767) {
    const IdealPid slow{.Kp = 1, .Ti = 3600, .Td = 400, .b = 1, .filter = {FilterType::derivative, 40}};
    EXPECT_THAT(refused("mitsubishi_fx_pid", slow).message,
                testing::AllOf(HasSubstr("TI would be 36000"), HasSubstr("TD would be 40000"), HasSubstr("32767")));
    const IdealPid slower{.Kp = 1, .Ti = 22000, .b = 1};
    EXPECT_THAT(refused("rockwell_slc_pid", slower).message, HasSubstr("TI_RG1 = 32767"));
    EXPECT_EQ(not_read("mitsubishi_fx_pid", {{"KP", 40000.0}, {"TI", 100.0}}).where, "settings/KP");
}

TEST(ProductNotes, ATimeThatNotEveryModelTakesIsTold) {
    const IdealPid slow{.Kp = 1, .Ti = 120, .Td = 20, .b = 1, .c = 1, .filter = {FilterType::derivative, 2}};
    EXPECT_EQ(note(nearest("abb_drive_pid", slow).notes, "range"),
              "derivation_time is 20, and not every model accepts it. ACS880 and ACS380 take up to 10 s.");
}

TEST(ProductNotes, WeightsThatTheBlockFixesComeWithTheExactPrefilter) {
    const auto fb41 = to_settings(product_of("siemens_fb41_cont_c"), kDesign, kContext, false);
    ASSERT_TRUE(fb41);
    EXPECT_THAT(note(fb41->notes, "setpoint-weights"), HasSubstr("b = 1, c = 1, the design with b = 0.6, c = 0"));
    EXPECT_THAT(note(fb41->notes, "prefilter"), HasSubstr("(1 + 72 s)/(1 + 120 s + 2400 s^2/(1 + 2 s))"));
    const auto compact = to_settings(product_of("siemens_pid_compact"), kDesign, kContext, false);
    ASSERT_TRUE(compact);
    EXPECT_FALSE(has_note(compact->notes, "setpoint-weights"));
    EXPECT_FALSE(has_note(compact->notes, "filter"));
    // b = 0 cannot be filtered back to b > 0.
    const auto yokogawa = to_settings(product_of("yokogawa_ff_pid"), kDesign, kContext, false);
    ASSERT_TRUE(yokogawa);
    EXPECT_TRUE(has_note(yokogawa->notes, "setpoint-weights"));
    EXPECT_FALSE(has_note(yokogawa->notes, "prefilter"));
}

TEST(ProductNotes, ASeriesBlockIsToldTheRatioOfTheDesignsOwnFilter) {
    const auto deltav = to_settings(product_of("emerson_deltav_series"), kDesign, kContext, false);
    ASSERT_TRUE(deltav);
    EXPECT_THAT(note(deltav->notes, "filter"), HasSubstr("Tf = 3.84"));
    EXPECT_THAT(note(deltav->notes, "filter-ratio"), HasSubstr("ALPHA = 0.07112"));
    std::vector<Note> notes;
    // x^2 - 122 x + 2640 = 0: RESET and RATE; GAIN = 3 RESET/120.
    const double root = std::sqrt(61.0 * 61 - 2640), RESET = 61 + root, RATE = 61 - root;
    const auto twin = to_controller(product_of("emerson_deltav_series"),
                                    {{"GAIN", 3 * RESET / 120}, {"RESET", RESET}, {"RATE", RATE}, {"ALPHA", 2 / RATE}},
                                    kContext, notes);
    ASSERT_TRUE(twin);
    EXPECT_NEAR(twin->Kp, 1.5, 1e-12);
    EXPECT_NEAR(twin->Ti, 120, 1e-11);
    EXPECT_NEAR(twin->Td, 20, 1e-12);
    EXPECT_NEAR(twin->filter.Tf, 2, 1e-12);
}

TEST(ProductNotes, FiltersOutOfRangeAreBroughtIntoIt) {
    IdealPid pid = kDesign;
    pid.filter = {FilterType::derivative, 0.5};
    const auto deltav = to_settings(product_of("emerson_deltav_standard"), pid, kContext, false);
    ASSERT_TRUE(deltav) << deltav.error().message;
    EXPECT_EQ(number(deltav->settings, "ALPHA"), 0.05);
    EXPECT_THAT(note(deltav->notes, "range"), HasSubstr("ALPHA would be 0.025"));
    EXPECT_NEAR(deltav->realised.filter.Tf, 1, 1e-12);
}

TEST(ProductNotes, WhatWasNotReadIsNamed) {
    const auto codes = [](const char* id) {
        return note(to_settings(product_of(id), kDesign, kContext, true)->notes, "unverified");
    };
    EXPECT_THAT(codes("abb_ac800m_pidcc"), HasSubstr("everything"));
    EXPECT_THAT(codes("foxboro_pid"), HasSubstr("the maker's document"));
    EXPECT_THAT(codes("simple_pid"), IsEmpty());
}

}  // namespace
}  // namespace tunewright::product
