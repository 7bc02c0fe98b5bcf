// Temperature controllers for panels: Eurotherm, Watlow, Yokogawa UTAdvanced, Omron E5, Delta DT.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

/// Proportional band in units of the measurement: the control error at which the output moves by its whole range.
constexpr Term kBandInUnits{.Kp = -1, .Su = 1};
constexpr std::string_view kBandBasis = "proportional band, in the unit of the measurement";
constexpr double kWholeSecond = 1;

/// A time in seconds; 0 stands for OFF.
Parameter seconds(std::string_view name, std::string_view label, ParameterRole role, double high, double resolution) {
    Parameter parameter{.name = name,
                        .label = label,
                        .unit = "s",
                        .role = role,
                        .term = role == ParameterRole::integral ? kTi : kTd,
                        .range = {0, high},
                        .resolution = resolution};
    if (role == ParameterRole::integral) parameter.off = 0.0;
    return parameter;
}

Product eurotherm() {
    return {
        .id = "eurotherm_3200",
        .maker = "Eurotherm",
        .name = "3116, 3216, 3208, 3204",
        .families = {"Eurotherm 3200", "3100 series", "3200 series"},
        .form = Form::ideal,
        .law = "OP = (100 %/PB) [ (SP - PV) + (1/(TI s)) (SP - PV) - TD s PV ] (believed)",
        .gain_basis = kBandBasis,
        .parameters =
            {
                {.name = "PB",
                 .label = "PB, proportional band",
                 .unit = "display units",
                 .role = ParameterRole::gain,
                 .term = kBandInUnits,
                 .range = {1, 9999},
                 .remark = "in display units, the default; it can be configured in percent"},
                seconds("TI", "TI, integral time", ParameterRole::integral, 9999, kWholeSecond),
                seconds("TD", "TD, derivative time", ParameterRole::derivative, 9999, kWholeSecond),
            },
        .filter = {FilterKind::unknown, 0, "Whether the derivative is filtered is not known."},
        .weights = {1, 0, "The derivative is taken as acting on the measurement."},
        .action = {.kind = Action::Kind::switched,
                   .name = "action",
                   .direct = std::string("direct"),
                   .reverse = std::string("reverse"),
                   .text = "The control action is configured; reverse heats."},
        .algorithm = {.published = false,
                      .text = "position or velocity: not known which",
                      .anti_windup = "not known",
                      .sample_time_text = "not known"},
        .traps = {"PB may be configured in percent instead of display units.",
                  "The relative cool gain R2G scales the band of cooling against PB."},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"names, units, ranges and meaning of PB, TI, TD, MR and R2G"},
                     .unverified = {"printed equation",
                                    "whether the derivative acts on the measurement or on the error", "filter",
                                    "base of a band in percent", "resolution of PB and of the times",
                                    "name of the switch of the direction", "discrete algorithm"},
                     .sources = {"Eurotherm 3116 manual p. 30 (control parameters)",
                                 "HA028651 3116 and 3200 Engineering Handbook (its PID pages could not be read)"}},
        .example = of_design_a({{"PB", 66.6667}, {"TI", 120.0}, {"TD", 20.0}}),
    };
}

Product watlow() {
    return {
        .id = "watlow_ez_zone",
        .maker = "Watlow",
        .name = "EZ-ZONE PM and RMC, F4T",
        .families = {"EZ-ZONE", "PM6", "F4T", "RMC"},
        .form = Form::ideal,
        .law = "power = (100 %/h.Pb) [ (SP - PV) + (1/(ti s)) (SP - PV) - td s PV ]",
        .gain_basis = kBandBasis,
        .parameters =
            {
                {.name = "h_Pb",
                 .label = "Heat Proportional Band, h.Pb",
                 .unit = "degrees or units",
                 .role = ParameterRole::gain,
                 .term = kBandInUnits,
                 .range = {0.001, 99999},
                 .remark = "The cool output has a band of its own, C.Pb."},
                seconds("ti", "Time Integral", ParameterRole::integral, 99999, 0),
                seconds("td", "Time Derivative", ParameterRole::derivative, 99999, 0),
            },
        .filter = {FilterKind::unknown, 0, "Whether the derivative is filtered is not known."},
        .weights = {1, 0, "The derivative follows the rate of change of the measurement."},
        .action = {.kind = Action::Kind::switched,
                   .name = "output",
                   .direct = std::string("cool"),
                   .reverse = std::string("heat"),
                   .text = "A heat output acts below the set point, a cool output above it."},
        .algorithm = {.published = false,
                      .text = "position or velocity: not known which",
                      .anti_windup = "older firmware clears the integral outside the proportional band",
                      .sample_time_text = "not known"},
        .traps =
            {"Older firmware has derivative action only within two proportional bands of the set point, and clears "
             "the integral outside the band.",
             "Within a dead band the proportional action stops, and the integral action continues."},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"power = 100 (SP - PV)/band", "meaning of the integral, the derivative and the dead band",
                              "units of band, integral (seconds per repeat) and derivative of the F4T"},
                     .unverified = {"units and ranges of ti and td of the EZ-ZONE", "0 as no integral action", "filter",
                                    "resolution", "discrete algorithm"},
                     .sources = {"EZ-ZONE PM manual pp. 195-196, PM user's guide p. 133, PM6 p. 81",
                                 "EZ-ZONE RMC manual p. 160", "F4T manual pp. 102-103"}},
        .example = of_design_a({{"h_Pb", 66.6667}, {"ti", 120.0}, {"td", 20.0}}),
    };
}

Product ut_advanced() {
    return {
        .id = "yokogawa_ut_advanced",
        .maker = "Yokogawa",
        .name = "UTAdvanced UT32A, UT35A, UT55A",
        .families = {"UT35A", "UT55A", "UT32A", "UTAdvanced"},
        .form = Form::ideal,
        .law = "OUT = (100/P) [ (b SP - PV) + (1/(I s)) (SP - PV) - D s PV ], all in percent",
        .gain_basis = "proportional band in percent of span",
        .parameters =
            {
                {.name = "P",
                 .label = "P, proportional band",
                 .unit = "%",
                 .role = ParameterRole::gain,
                 .term = kBand,
                 .range = {0.1, 999.9},
                 .resolution = 0.1,
                 .remark = "0.0 acts as 0.1."},
                seconds("I", "I, integral time", ParameterRole::integral, 6000, kWholeSecond),
                seconds("D", "D, derivative time", ParameterRole::derivative, 6000, kWholeSecond),
                {.name = "ALG",
                 .label = "ALG, PID control mode",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = 0.0, .b = 1, .c = 0}, {.value = 1.0, .b = 0, .c = 0}},
                 .remark = "0: standard, the output jumps with the set point; 1: fixed-point, it does not."},
            },
        .filter = {FilterKind::unknown, 0, "Whether the derivative is filtered is not known."},
        .weights = {1, 0, "For a local set point. With a remote one the standard mode has b = 1 and c = 1."},
        .action = {.kind = Action::Kind::switched,
                   .name = "action",
                   .direct = std::string("direct"),
                   .reverse = std::string("reverse"),
                   .text = "The printed equation has the error PV - SP; the control action is direct or reverse."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .published = false,
                      .text = "differences PVn - PVn-1 over one control period",
                      .anti_windup = "not known",
                      .sample_time_text = "control period"},
        .traps = {"A larger proportional band is a smaller gain.",
                  "With a remote set point the standard mode differentiates the error, and so does a secondary loop."},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"equation of the deviation derivative type and of PD control",
                              "which type acts in which mode", "range of P and D, P = 0 as 0.1, OFF"},
                     .unverified = {"range of I (taken from D)", "base of the percent (the range of the input assumed)",
                                    "that the bumpless type has b = 0", "filter", "name of the switch of the direction",
                                    "discrete algorithm"},
                     .sources = {"IM 05P01C31-01EN pp. 6-28, 8-87, 8-88 (UT55A)",
                                 "IM 05P01D31-01EN pp. 8-22, 8-24 (UT32A, UT35A)"}},
        .example = of_design_a({{"P", 33.3}, {"I", 120.0}, {"D", 20.0}, {"ALG", 0.0}}),
    };
}

Product omron_e5() {
    return {
        .id = "omron_e5",
        .maker = "Omron",
        .name = "E5CN, E5CC, E5EC (input of a temperature)",
        .families = {"E5CC", "E5CN", "E5EC", "E5DC"},
        .form = Form::ideal,
        .law = "MV = (100 %/P) [ (b SP - PV) + (1/(I s)) (SP - PV) - D s PV ] (believed)",
        .gain_basis = kBandBasis,
        .parameters =
            {
                {.name = "P",
                 .label = "Proportional Band",
                 .unit = "degC or degF",
                 .role = ParameterRole::gain,
                 .term = kBandInUnits,
                 .range = {0.1, 999.9},
                 .resolution = 0.1,
                 .standard = 8.0,
                 .remark = "With an analog input it is in percent of the input's full scale."},
                seconds("I", "Integral Time", ParameterRole::integral, 3999, kWholeSecond),
                seconds("D", "Derivative Time", ParameterRole::derivative, 3999, kWholeSecond),
            },
        .filter = {FilterKind::unknown, 0, "Whether the derivative is filtered is not known."},
        .weights = {1, 0,
                    "It is a 2-PID control, whose set-point filter is not known; without that filter b = 1 and c = 0."},
        .action = {.kind = Action::Kind::switched,
                   .name = "direct_reverse",
                   .direct = std::string("direct"),
                   .reverse = std::string("reverse"),
                   .text = "Reverse operation heats."},
        .algorithm = {.published = false,
                      .text = "position or velocity: not known which",
                      .anti_windup = "not known",
                      .sample_time_text = "not known"},
        .traps = {"The robust tuning RT, and the unit of times of the E5_C, set the step of I or D to 0.1 s.",
                  "With an analog input P is in percent of full scale, not in units.",
                  "The control must be set to PID: it is ON/OFF by default in some models."},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"unit, range and default of P, I and D of the E5CN", "meaning of the three actions",
                              "2-PID or ON/OFF control"},
                     .unverified = {"printed equation", "parameter alpha of the set-point filter",
                                    "0 as no integral action",
                                    "whether the derivative acts on the measurement or on the error", "filter",
                                    "discrete algorithm"},
                     .sources = {"Omron E5CN user's manual p. 172", "H174 (E5_C) pp. 4-27, 6-28", "E5GN p. 3-7"}},
        .example = of_design_a({{"P", 66.7}, {"I", 120.0}, {"D", 20.0}}),
    };
}

Product delta_dt() {
    return {
        .id = "delta_dt",
        .maker = "Delta",
        .name = "DTA, DTB, DTD temperature controllers",
        .families = {"DTA", "DTB", "DTD"},
        .form = Form::ideal,
        .law = "MV = (100 %/PB) [ (SV - PV) + (1/(Ti s)) (SV - PV) - Td s PV ] (believed)",
        .gain_basis = kBandBasis,
        .parameters =
            {
                {.name = "PB",
                 .label = "PB, proportional band",
                 .unit = "degrees",
                 .role = ParameterRole::gain,
                 .term = kBandInUnits,
                 .range = {0.1, 999.9},
                 .resolution = 0.1},
                seconds("Ti", "Ti, integral time", ParameterRole::integral, 9999, kWholeSecond),
                seconds("Td", "Td, derivative time", ParameterRole::derivative, 9999, kWholeSecond),
            },
        .filter = {FilterKind::unknown, 0, "Whether the derivative is filtered is not known."},
        .weights = {1, 0, "The derivative is taken as acting on the measurement."},
        .action = {.kind = Action::Kind::switched,
                   .name = "control",
                   .direct = std::string("Cooling"),
                   .reverse = std::string("Heating"),
                   .text = "Register 4718H of the DTA: 0 for heating, 1 for cooling."},
        .algorithm = {.published = false,
                      .text = "position or velocity: not known which",
                      .anti_windup = "the integral starts at a value of its own, the integral default",
                      .sample_time_text = "not known"},
        .traps = {"The register of PB counts tenths of a degree."},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"ranges and registers of PB, Ti and Td, and heating or cooling, of the DTA",
                              "full output at SV - PB in heating, and at SV + PB in cooling, of the DTD"},
                     .unverified = {"printed equation", "unit of Ti and Td (seconds assumed)",
                                    "whether the derivative acts on the measurement or on the error", "filter",
                                    "discrete algorithm"},
                     .sources = {"Delta A series manual p. 8 (registers 4708H to 470AH, 4718H)",
                                 "DTD instruction sheet p. 4"}},
        .example = of_design_a({{"PB", 66.7}, {"Ti", 120.0}, {"Td", 20.0}}),
    };
}

}  // namespace

std::vector<Product> panel_controller_products() {
    return {eurotherm(), watlow(), ut_advanced(), omron_e5(), delta_dt()};
}

}  // namespace tunewright::product
