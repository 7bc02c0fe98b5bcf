// Blocks for soft PLCs whose source is open: the standard PID of OpenPLC, matiec and Beremiz, and OSCAT's.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

Product openplc() {
    return {
        .id = "openplc_iec_pid",
        .maker = "OpenPLC",
        .name = "OpenPLC / matiec / Beremiz standard PID (IEC 61131-3)",
        .form = Form::ideal,
        .law = "XOUT = KP [ e + (1/(TR s)) e + TD de/dt + X0 ], e = PV - SP",
        .gain_basis = "engineering units",
        .parameters =
            {
                {.name = "KP",
                 .label = "KP",
                 .role = ParameterRole::gain,
                 .term = times(-1, kKp),
                 .remark = "negative for a heater: the error is PV - SP"},
                {.name = "TR",
                 .label = "TR",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = {0, kUnbounded}},
                {.name = "TD",
                 .label = "TD",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kUnbounded}},
                {.name = "CYCLE_s",
                 .label = "CYCLE",
                 .unit = "s",
                 .role = ParameterRole::sample_time,
                 .term = {.Ts = 1},
                 .range = {0, kUnbounded}},
            },
        .filter =
            {FilterKind::four_points, 0,
             "A slope through four points, with a delay of 1.5 periods; a first-order Tf of one period has the same "
             "delay."},
        .weights = {1, 1, "All three parts act on the error."},
        .action = {.kind = Action::Kind::signed_gain, .text = "A positive KP raises the output while PV is above SP."},
        .algorithm = {.derivative = DerivativeRule::four_points,
                      .text = "position algorithm",
                      .anti_windup = "none, and no limits of the output",
                      .sample_time_text = "the input CYCLE"},
        .traps = {"Its sign differs from all other products: a positive KP on a heater is positive feedback.",
                  "The block limits neither the output nor the integral; the caller must do it.",
                  "The output in manual is KP X0, not X0."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"generated code of PID, INTEGRAL and DERIVATIVE", "conversion of TIME to seconds"},
                     .unverified = {"other runtimes with the same block"},
                     .sources = {"thiagoralves/OpenPLC_v3 webserver/core/lib/iec_std_FB.h",
                                 "iec_std_lib, __time_to_real"}},
        .example = of_design_a({{"KP", -1.5}, {"TR", 120.0}, {"TD", 20.0}, {"CYCLE_s", 0.25}}),
        .snippets = {{"Structured text, for the instance loop",
                      "loop.KP := {KP};\n"
                      "loop.TR := {TR};\n"
                      "loop.TD := {TD};\n"
                      "loop.CYCLE := T#{sample_time_ms}ms;"}},
    };
}

Product oscat() {
    return {
        .id = "oscat_ctrl_pid",
        .maker = "OSCAT",
        .name = "OSCAT Basic CTRL_PID / FT_PIDWL",
        .form = Form::ideal,
        .law = "Y = KP [ e + (1/(TN s)) e + TV s e ], e = SET - ACT",
        .gain_basis = "engineering units",
        .parameters =
            {
                {.name = "KP", .label = "KP", .role = ParameterRole::gain, .term = kKp, .standard = 1.0},
                {.name = "TN",
                 .label = "TN",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = {0, kUnbounded},
                 .standard = 1.0},
                {.name = "TV",
                 .label = "TV",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kUnbounded},
                 .standard = 1.0},
            },
        .filter = {FilterKind::none, 0, "None; SUP is a noise band of the error."},
        .weights = {1, 1, "All three parts act on the error."},
        .action = kSigned,
        .algorithm = {.integral = IntegralRule::trapezoidal,
                      .derivative = DerivativeRule::difference,
                      .text = "position algorithm",
                      .anti_windup = "the integrator is limited (FT_PIWL); LL and LH are "
                                     "-1000 and 1000 by default",
                      .sample_time_text = "has no fixed period; it measures its interval"},
        .traps = {"TV is 1 s by default: set it to 0 for a PI."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"interfaces and defaults", "formula, trapezoidal rule", "TN = KP/KI, TV = KD/KP"},
                     .unverified = {"body of FT_PIWL"},
                     .sources = {"OSCAT CTRL_PID, source text (public copy)", "OSCAT manual, FT_PIDWL",
                                 "docs.ms-muc-docs.de, OSCAT CTRL_PID and FT_PIDWL"}},
        .example = of_design_a({{"KP", 1.5}, {"TN", 120.0}, {"TV", 20.0}}),
        .snippets = {{"Structured text, for the instance loop",
                      "loop.KP := {KP};\n"
                      "loop.TN := {TN};\n"
                      "loop.TV := {TV};"}},
    };
}

}  // namespace

std::vector<Product> open_plc_products() { return {openplc(), oscat()}; }

}  // namespace tunewright::product
