// Properties of the conversions beyond single settings: round trips, units of time, resolution, clocks, sampled laws.
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>

#include "engine/controller/product/to_controller.h"
#include "tests/engine/controller/product/support.h"

namespace tunewright::product {
namespace {

using testing::HasSubstr;

Converted converted(std::string_view id, const IdealPid& pid, const Context& context = kContext, bool nearest = false) {
    auto answer = to_settings(product_of(id), pid, context, nearest);
    if (!answer) throw std::runtime_error(answer.error().message);
    return *answer;
}
IdealPid controller(std::string_view id, const Settings& settings, const Context& context = kContext) {
    std::vector<Note> notes;
    auto answer = to_controller(product_of(id), settings, context, notes);
    if (!answer) throw std::runtime_error(answer.error().message);
    return *answer;
}

TEST(ProductConversions, RandomSettingsGoToTheTwinAndBack) {
    std::mt19937 random(20261123);
    std::uniform_real_distribution<double> exponent(-1, 1), share(0, 1);
    for (const Product& product : catalogue()) {
        for (int k = 0; k < 20; ++k) {
            // Far from every limit: Ti above 4 Td/(1 - alpha), gains within Yokogawa's, filters within DeltaV's.
            IdealPid pid{.Kp = 1.5 * std::pow(3, exponent(random)), .Ti = 120 * std::pow(3, exponent(random))};
            pid.Td = pid.Ti * (0.05 + 0.15 * share(random));
            pid.filter = {FilterType::derivative, pid.Td * (0.06 + 0.5 * share(random))};
            pid.b = share(random);
            Context context = kContext;
            context.spans = {-10, 190 + 50 * share(random), 3, 103 + 20 * share(random)};
            const auto first = to_settings(product, pid, context, false);
            ASSERT_TRUE(first) << product.id << ": " << first.error().message;
            std::vector<Note> notes;
            const auto twin = to_controller(product, first->settings, context, notes);
            ASSERT_TRUE(twin) << product.id << ": " << twin.error().message;
            EXPECT_TRUE(to_digits(twin->Kp, pid.Kp, 1e-12)) << product.id;
            if (product.form == Form::p_only) continue;
            EXPECT_TRUE(to_digits(twin->Ti, pid.Ti, 1e-12)) << product.id;
            EXPECT_TRUE(to_digits(twin->Td, pid.Td, 1e-12)) << product.id;
            const auto second = to_settings(product, *twin, context, false);
            ASSERT_TRUE(second) << product.id << ": " << second.error().message;
            for (const Setting& setting : first->settings) {
                if (!std::holds_alternative<double>(setting.value)) continue;
                EXPECT_TRUE(to_digits(number(second->settings, setting.name), std::get<double>(setting.value), 1e-9))
                    << product.id << " " << setting.name;
            }
        }
    }
}

TEST(ProductConversions, TheCallersUnitOfTimeChangesNothingInTheBlock) {
    const IdealPid in_minutes{
        .Kp = 1.5, .Ti = 2, .Td = 20.0 / 60, .b = 0.6, .c = 0, .filter = {FilterType::derivative, 2.0 / 60}};
    Context minutes = kContext;
    minutes.seconds_per_time = 60;
    for (const Product& product : catalogue()) {
        const auto by_seconds = to_settings(product, kDesign, kContext, false);
        const auto by_minutes = to_settings(product, in_minutes, minutes, false);
        ASSERT_TRUE(by_seconds && by_minutes) << product.id;
        ASSERT_EQ(by_seconds->settings.size(), by_minutes->settings.size());
        for (std::size_t i = 0; i < by_seconds->settings.size(); ++i) {
            if (!std::holds_alternative<double>(by_seconds->settings[i].value)) continue;
            EXPECT_TRUE(to_digits(std::get<double>(by_minutes->settings[i].value),
                                  std::get<double>(by_seconds->settings[i].value), 1e-12))
                << product.id << " " << by_seconds->settings[i].name;
        }
        EXPECT_TRUE(to_digits(by_minutes->realised.Ti * 60, by_seconds->realised.Ti, 1e-12)) << product.id;
        EXPECT_TRUE(to_digits(by_minutes->realised.filter.Tf * 60, by_seconds->realised.filter.Tf, 1e-12))
            << product.id;
    }
}

TEST(ProductConversions, WholeNumbersAreTypedAndRealisedAsSuch) {
    const Converted slc = converted("rockwell_slc_pid", kDesign);
    EXPECT_DOUBLE_EQ(number(slc.settings, "TD"), 100.0 * 20 / 60);
    EXPECT_DOUBLE_EQ(number(as_typed(product_of("rockwell_slc_pid"), slc.settings), "TD"), 33);
    EXPECT_NEAR(slc.realised.Td, 19.8, 1e-12);
    EXPECT_THAT(note(slc.notes, "rounding"), HasSubstr("TD 33 for 33.3333"));

    const Converted omron = converted("omron_pid190", kDesign);
    EXPECT_NEAR(omron.realised.Kp, 100 / 33.3 * 100 / 200, 1e-12);
    EXPECT_NEAR(omron.realised.b, 0.6, 1e-15);

    const Example& flight = product_of("betaflight").example;
    const Converted betaflight = converted("betaflight", flight.design, context_of(flight));
    EXPECT_NEAR(betaflight.realised.Kp, 50 * 0.032029, 1e-12);
    EXPECT_NEAR(betaflight.realised.Ti, 50 * 0.032029 / (82 * 0.244381), 1e-12);
    EXPECT_NEAR(betaflight.realised.Td, 42 * 0.000529 / (50 * 0.032029), 1e-12);
}

TEST(ProductConversions, RealisedWeightsAndFiltersAreThoseOfThePublishedExamples) {
    struct Row {
        const char* id;
        double b, c, Tf;
    };
    for (const Row& row :
         {Row{"siemens_fb41_cont_c", 1, 1, 2}, Row{"rockwell_pid_independent", 1, 0, 0}, Row{"abb_fc19", 1, 1, 0},
          Row{"emerson_deltav_series", 0.775978, 0, 3.84037}, Row{"honeywell_interactive_b", 0.779129, 0, 2.94495},
          Row{"foxboro_pid", 0.788675, 0, 2}, Row{"omron_pid190", 0.6, 0, 0}, Row{"beckhoff_fb_ctrl_pid", 1, 0, 2},
          Row{"openplc_iec_pid", 1, 1, 0.25}, Row{"quickpid", 0.5, 0, 0}, Row{"simple_pid", 1, 0, 0},
          Row{"reprapfirmware", 1, 0, 0.375}, Row{"esphome_pid", 1, 0, 2}, Row{"klipper", 1, 0, 2}}) {
        const IdealPid realised = converted(row.id, kDesign).realised;
        EXPECT_NEAR(realised.b, row.b, 5e-7) << row.id;
        EXPECT_EQ(realised.c, row.c) << row.id;
        EXPECT_NEAR(realised.filter.Tf, row.Tf, 5e-6) << row.id;
    }
    EXPECT_EQ(converted("foxboro_pid", kDesign).realised.filter.type, FilterType::measurement_second_order);
}

TEST(ProductConversions, TheClockOfAFirmwareIsItsOwnUnlessTheLoopRunsAtAnother) {
    Context context = kContext;
    EXPECT_DOUBLE_EQ(number(converted("klipper", kDesign, context).settings, "smooth_time"), 2.3);
    EXPECT_THAT(note(converted("klipper", kDesign, context).notes, "clock"), HasSubstr("0.3 s"));
    context.loop_clock_s = 0.25;
    EXPECT_DOUBLE_EQ(number(converted("klipper", kDesign, context).settings, "smooth_time"), 2.25);
    EXPECT_FALSE(has_note(converted("klipper", kDesign, context).notes, "clock"));
    EXPECT_NEAR(controller("klipper", {{"pid_Kp", 3.825}, {"smooth_time", 2.3}}, context).filter.Tf, 0, 1e-15);
    EXPECT_NEAR(controller("klipper", {{"pid_Kp", 3.825}, {"pid_Kd", 76.5}, {"smooth_time", 2.3}}, context).filter.Tf,
                2.05, 1e-12);
    EXPECT_EQ(default_sample_time_s(product_of("marlin")), 0.1638);
    EXPECT_EQ(default_sample_time_s(product_of("emerson_deltav_series")), std::nullopt);
}

TEST(ProductConversions, NegativeGainsAreTypedAsEachBlockTakesThem) {
    IdealPid direct = kDesign;
    direct.Kp = -1.5;
    const Converted siemens = converted("siemens_pid_compact", direct);
    EXPECT_DOUBLE_EQ(number(siemens.settings, "Gain"), 1.5);
    EXPECT_EQ(named(siemens.settings, "InvertControl"), "true");
    EXPECT_DOUBLE_EQ(siemens.realised.Kp, -1.5);
    EXPECT_TRUE(has_note(siemens.notes, "action"));
    EXPECT_DOUBLE_EQ(number(converted("openplc_iec_pid", direct).settings, "KP"), 1.5);
    EXPECT_EQ(named(converted("arduino_pid_v1", direct).settings, "ControllerDirection"), "REVERSE");
    EXPECT_DOUBLE_EQ(number(converted("matlab_pid", direct).settings, "Ki"), -0.0125);
    EXPECT_DOUBLE_EQ(converted("matlab_pid", direct).realised.Ti, 120);
    for (const Product& product : catalogue()) {
        if (product.action.kind == Action::Kind::reverse_only) continue;
        const auto answer = to_settings(product, direct, kContext, false);
        ASSERT_TRUE(answer) << product.id << ": " << answer.error().message;
        EXPECT_LT(answer->realised.Kp, 0) << product.id;
    }
}

TEST(ProductConversions, WithoutIntegralActionTheOffValueIsTyped) {
    IdealPid pd = kDesign;
    pd.Ti = kNever;
    EXPECT_EQ(number(converted("siemens_pid_compact", pd).settings, "Ti"), 0);
    EXPECT_EQ(number(converted("omron_pid190", pd).settings, "Tik_0_1s"), 9999);
    EXPECT_EQ(number(converted("rockwell_pid_independent", pd).settings, "KI"), 0);
    for (const char* id : {"siemens_pid_compact", "omron_pid190", "rockwell_pid_independent", "simple_pid"})
        EXPECT_FALSE(converted(id, pd).realised.has_integral()) << id;
    EXPECT_THAT(note(converted("epics_epid", pd).notes, "integral-off"), HasSubstr("DRVL"));
}

TEST(ProductConversions, WithoutDerivativeTheFilterKeepsTheMakersDefault) {
    IdealPid pi = kDesign;
    pi.Td = 0;
    pi.filter = {};
    EXPECT_EQ(number(converted("emerson_deltav_series", pi).settings, "ALPHA"), 0.125);
    EXPECT_DOUBLE_EQ(number(converted("emerson_deltav_series", pi).settings, "RESET"), 120);
    EXPECT_EQ(number(converted("simulink_pid_parallel", pi).settings, "N"), 100);
    for (const Product& product : catalogue()) {
        const auto answer = to_settings(product, pi, kContext, false);
        ASSERT_TRUE(answer) << product.id << ": " << answer.error().message;
        EXPECT_EQ(answer->realised.Td, 0) << product.id;
        EXPECT_EQ(answer->realised.filter, Filter{}) << product.id;
    }
}

TEST(ProductConversions, AFilterOfTheMeasurementIsRunWhereTheBlockHasOne) {
    IdealPid pid = kDesign;
    pid.filter = {FilterType::measurement_second_order, 2};
    const Converted julia = converted("controlsystems_jl_pid", pid);
    EXPECT_EQ(number(julia.settings, "filter_order"), 2);
    EXPECT_EQ(julia.realised.filter, pid.filter);
    EXPECT_FALSE(has_note(julia.notes, "filter"));
    const Converted siemens = converted("siemens_pid_compact", pid);
    EXPECT_DOUBLE_EQ(number(siemens.settings, "TdFiltRatio"), 0.1);
    EXPECT_THAT(note(siemens.notes, "filter"), HasSubstr("ilter the measurement before the block"));
}

TEST(ProductConversions, ASlopeOfOneSampleIsThePlainDifferenceAndIsNoFilter) {
    IdealPid pid = kDesign;
    pid.filter = {};
    for (const char* id : {"esphome_pid", "ha_smart_thermostat", "klipper"})
        EXPECT_FALSE(has_note(converted(id, pid, kContext, true).notes, "filter")) << id;
    pid.filter = {FilterType::derivative, 2};
    EXPECT_THAT(note(converted("esphome_pid", pid, kContext, true).notes, "filter"),
                HasSubstr("slope over several samples"));
}

TEST(ProductConversions, SampledLawsFollowTheBlocksRules) {
    const auto law = [](const char* id, double Ts) {
        return sampled_law(product_of(id), converted(id, kDesign).settings, kContext, Ts);
    };
    EXPECT_EQ(law("oscat_ctrl_pid", 0.25).integral, IntegralRule::trapezoidal);
    EXPECT_EQ(law("px4_rate", 0.25).integral, IntegralRule::forward);
    EXPECT_EQ(law("openplc_iec_pid", 0.25).derivative, DerivativeRule::four_points);
    EXPECT_TRUE(law("rockwell_pide_independent", 0.25).velocity);
    EXPECT_EQ(law("esphome_pid", 0.25).slope_samples, 17);
    EXPECT_EQ(law("reprapfirmware", 0.25).slope_samples, 4);
    const SampledPid klipper = law("klipper", 0.2);
    EXPECT_EQ(klipper.Ts, 0.2);
    EXPECT_NEAR(klipper.gains.Kd, 30, 1e-12);
    // smooth_time 2.3 in a loop that runs every 0.2 s.
    EXPECT_NEAR(klipper.gains.filter.Tf, 2.1, 1e-12);
    EXPECT_EQ(sampled_law(product_of("klipper"), {{"no", 1.0}}, kContext, 1).gains.Kp, 0);
}

TEST(ProductConversions, TextsAreWrittenInTheBlocksResolution) {
    const auto typed = [](const char* id, const char* name, const Value& value) {
        return typed_text(product_of(id), {name, value});
    };
    EXPECT_EQ(typed("siemens_pid_compact", "Gain", 1.5), "1.50");
    EXPECT_EQ(typed("siemens_pid_compact", "Gain", 0.00833333), "0.008333");
    EXPECT_EQ(typed("siemens_pid_compact", "Ti", 1234.567), "1234.57");
    EXPECT_EQ(typed("siemens_pid_compact", "Ti", 0.0), "0.00");
    EXPECT_EQ(typed("siemens_fb41_cont_c", "TI_s", 37.12345), "37.123");
    EXPECT_EQ(typed("omron_pid190", "P", 333.333), "333");
    EXPECT_EQ(typed("omron_pid190", "alpha_code", std::string("140")), "140");
    EXPECT_EQ(typed("beckhoff_fb_ctrl_pid", "bPInTheFeedbackPath", true), "true");
}

TEST(ProductConversions, ASearchSeesGainTimesAndFilterWithTheirRanges) {
    const auto tunable = tunable_parameters(product_of("emerson_deltav_series"));
    ASSERT_EQ(tunable.size(), 4U);
    EXPECT_EQ(tunable[0].role, ParameterRole::gain);
    EXPECT_EQ(tunable[3].name, "ALPHA");
    EXPECT_EQ(tunable[3].range.low, 0.05);
    EXPECT_EQ(tunable[3].range.high, 1);
    EXPECT_EQ(tunable_parameters(product_of("omron_pid190"))[0].resolution, 1);
}

TEST(ProductConversions, FormulasReadAsTheirTerms) {
    const auto formula = [](const char* id, const char* name) {
        return formula_text(product_of(id), *parameter_named(product_of(id), name));
    };
    EXPECT_EQ(formula("siemens_fb41_cont_c", "GAIN"), "Kp Sy/Su");
    EXPECT_EQ(formula("rockwell_pide_independent", "IGain"), "60 Kp Sy/(Ti Su)");
    EXPECT_EQ(formula("rockwell_pid_dependent", "KD"), "Td/60");
    EXPECT_EQ(formula("yokogawa_centum_pid", "PB"), "100 Su/(Kp Sy)");
    EXPECT_EQ(formula("foxboro_pid", "PBAND"), "100 Su/(Kc Sy)");
    EXPECT_EQ(formula("ardupilot_ac_pid", "FLTD"), "1/(2 pi Tf)");
    EXPECT_EQ(formula("discretepids_jl", "Tt"), "sqrt(Td Ti)");
    EXPECT_EQ(formula("betaflight", "P"), "Kp/0.032029");
    EXPECT_EQ(formula("schneider_pidff_mixed", "ovs_att"), "1 - b");
}

}  // namespace
}  // namespace tunewright::product
