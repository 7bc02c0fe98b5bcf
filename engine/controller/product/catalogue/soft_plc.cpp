// Soft PLCs of makers: Beckhoff TwinCAT, CODESYS.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

constexpr double kInMilliseconds = 1000;
/// The largest TIME: T#49D17H2M47S295MS.
constexpr double kMaxTime_ms = 4294967295;

Parameter ms_time_of(std::string_view name, std::string_view label, ParameterRole role, Term term) {
    return {.name = name,
            .label = label,
            .unit = "ms",
            .role = role,
            .term = times(kInMilliseconds, term),
            .range = {role == ParameterRole::integral ? 1.0 : 0.0, kMaxTime_ms},
            .resolution = kWholeNumber};
}

Product beckhoff() {
    return {
        .id = "beckhoff_fb_ctrl_pid",
        .maker = "Beckhoff",
        .name = "TwinCAT FB_CTRL_PID / FB_BasicPID",
        .families = {"TwinCAT 2", "TwinCAT 3", "Tc2_ControllerToolbox"},
        .form = Form::ideal,
        .law = "out = fKp [ (b w - x) + (1/(tTn s)) (w - x) + (tTv s/(tTd s + 1)) (c w - x) ]",
        .gain_basis = "engineering units",
        .parameters =
            {
                {.name = "fKp", .label = "fKp", .role = ParameterRole::gain, .term = kKp},
                ms_time_of("tTn_ms", "tTn", ParameterRole::integral, kTi),
                ms_time_of("tTv_ms", "tTv", ParameterRole::derivative, kTd),
                ms_time_of("tTd_ms", "tTd", ParameterRole::filter, kTf),
                {.name = "bPInTheFeedbackPath",
                 .label = "bPInTheFeedbackPath",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = false, .b = 1}, {.value = true, .b = 0}}},
                {.name = "bDInTheFeedbackPath",
                 .label = "bDInTheFeedbackPath",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = false, .c = 1}, {.value = true, .c = 0}}},
            },
        .filter = {FilterKind::parameter, 0, "First order with the damping time tTd."},
        .weights = {1, 1, "Each is 0 or 1, by a switch."},
        .action = {.kind = Action::Kind::signed_gain, .text = "The sign of fKp (unverified)."},
        .algorithm = {.published = false,
                      .text = "position algorithm",
                      .anti_windup = "an anti-reset windup, with bARWOnIPartOnly only of the integral",
                      .sample_time_text = "tCtrlCycleTime, usually the period of the task"},
        .traps = {"tTd is the filter, tTv the derivative."},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"names and units of the parameters", "additive form", "both switches and their defaults",
                              "range of a TIME"},
                     .unverified = {"transfer function", "default of tTd", "discrete algorithm", "sign of fKp"},
                     .sources = {"infosys.beckhoff.com tf4100_tc3_controller_toolbox/245435787",
                                 "infosys.beckhoff.com tcplclib_tc2_utilities/34976395",
                                 "infosys.beckhoff.com tf8400_tc3_mtp_runtime/15140780555",
                                 "infosys.beckhoff.com tc3_plc_intro/12189021579"}},
        .example = of_design_a({{"fKp", 1.5},
                                {"tTn_ms", 120000.0},
                                {"tTv_ms", 20000.0},
                                {"tTd_ms", 2000.0},
                                {"bPInTheFeedbackPath", false},
                                {"bDInTheFeedbackPath", true}}),
        .snippets = {{"Structured text, for the parameters stParams",
                      "stParams.fKp := {fKp};\n"
                      "stParams.tTn := T#{tTn_ms}ms;\n"
                      "stParams.tTv := T#{tTv_ms}ms;\n"
                      "stParams.tTd := T#{tTd_ms}ms;\n"
                      "stParams.bPInTheFeedbackPath := {bPInTheFeedbackPath=true:TRUE/FALSE};\n"
                      "stParams.bDInTheFeedbackPath := {bDInTheFeedbackPath=true:TRUE/FALSE};"}},
    };
}

Product codesys() {
    return {
        .id = "codesys_util_pid",
        .maker = "CODESYS",
        .name = "Util PID / PID_FIXCYCLE",
        .families = {"WAGO", "e!COCKPIT", "ifm", "Festo CPX"},
        .form = Form::ideal,
        .law = "Y = Y_OFFSET + KP [ 1 + 1/(TN s) + TV s ] (SET_POINT - ACTUAL)",
        .gain_basis = "engineering units",
        .parameters =
            {
                {.name = "KP", .label = "KP", .role = ParameterRole::gain, .term = kKp, .remark = "must not be 0"},
                {.name = "TN",
                 .label = "TN",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = {0, kUnbounded}},
                {.name = "TV",
                 .label = "TV",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kUnbounded}},
            },
        .filter = {FilterKind::none},
        .weights = {1, 1, "All three parts act on the error."},
        .action = kSigned,
        .algorithm = {.derivative = DerivativeRule::difference,
                      .published = false,
                      .text = "position algorithm with Y_OFFSET; the derivative is a difference",
                      .anti_windup = "limits Y_MIN and Y_MAX with OVERFLOW; both 0 is no limit",
                      .sample_time_text = "measured between calls in ms; CYCLE of PID_FIXCYCLE"},
        .traps = {"In a task of 1 ms the block measures 0 or 2 ms: use PID_FIXCYCLE.",
                  "According to its documentation new parameters take effect only in manual mode, at the start or at a "
                  "reset."},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"equation of PD", "notes on PID", "units, limits"},
                     .unverified = {"formula of the integral and its limits"},
                     .sources = {"content.helpme-codesys.com Util 3.5.18.0, Controller, PID",
                                 "zh.helpme-codesys.com Util, PD and PID", "5ichai.com, CODESYS PID help in Chinese"}},
        .example = of_design_a({{"KP", 1.5}, {"TN", 120.0}, {"TV", 20.0}}),
        .snippets = {{"Structured text, for the instance loop",
                      "loop.KP := {KP};\n"
                      "loop.TN := {TN};\n"
                      "loop.TV := {TV};"}},
    };
}

}  // namespace

std::vector<Product> soft_plc_products() { return {beckhoff(), codesys()}; }

}  // namespace tunewright::product
