// Emerson DeltaV and Honeywell TDC 3000 / Experion, each in its series and its ideal form.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

constexpr Range kAlphaRange{0.05, 1};
constexpr double kDeltaVAlpha = 0.125;

const Action kDeltaVAction{.kind = Action::Kind::switched,
                           .name = "Direct_Acting",
                           .direct = true,
                           .reverse = false,
                           .text = "Direct_Acting is an option in CONTROL_OPTS."};

Algorithm deltav_algorithm() {
    return {.published = false,
            .text = "position algorithm; the integral is a lag in positive feedback (external reset)",
            .anti_windup = "outside ARW_HI_LIM and ARW_LO_LIM, in engineering units, RESET is divided by 16",
            .sample_time_text = "the scan of the module"};
}

Parameter deltav_alpha() {
    return {.name = "ALPHA",
            .label = "ALPHA",
            .role = ParameterRole::filter,
            .term = kFilterRatio,
            .range = kAlphaRange,
            .standard = kDeltaVAlpha,
            .remark = "The fieldbus block has 0.1, fixed."};
}

constexpr const char* kOwnStructure = "PI action on error, D action on PV";  // the default

Parameter deltav_structure() {
    return {.name = "STRUCTURE",
            .label = "STRUCTURE",
            .role = ParameterRole::choice,
            .shape = Shape::option,
            .options = {{.value = std::string(kOwnStructure), .b = 1, .c = 0},
                        {.value = std::string("PID action on error"), .b = 1, .c = 1},
                        {.value = std::string("I action on error, PD action on PV"), .b = 0, .c = 0},
                        {.value = std::string("P action on error, D action on PV"), .b = 1, .c = 0, .integral = false},
                        {.value = std::string("PD action on error"), .b = 1, .c = 1, .integral = false},
                        {.value = std::string("Two degrees of freedom controller"), .free_weights = true}},
            .remark = "BETA and GAMMA have an effect only with two degrees of freedom."};
}

const GainScheduling kDeltaVScheduling{
    .sets = 3,
    .between = Interpolation::steps,
    .text =
        "The module template PID_GAINSCHED holds GAIN, RESET and RATE of three regions, selected by PV, OUT or another "
        "signal; within a dead band at the two borders it interpolates linearly between the sets.",
    .source = "DeltaV Books Online, PID_GAINSCHED module template"};

Evidence deltav_evidence(std::vector<std::string_view> read, std::vector<std::string_view> unverified) {
    return {.level = EvidenceLevel::read,
            .read = std::move(read),
            .unverified = std::move(unverified),
            .sources = {"DeltaV Books Online, parameters of the PID function block",
                        "PID function block (docsbay.net copy)",
                        "Emerson Automation Experts 2013, converting PID values", "Rosemount OCX8800A manual p. 168"}};
}

Product deltav_standard() {
    return {
        .id = "emerson_deltav_standard",
        .maker = "Emerson",
        .name = "DeltaV PID, FORM Standard",
        .families = {"DeltaV", "Fisher-Rosemount"},
        .form = Form::ideal,
        .law = "OUT = GAIN [ (BETA SP - PV) + (1/(RESET s)) (SP - PV) + (RATE s/(ALPHA RATE s + 1)) (GAMMA SP - PV) ]",
        .gain_basis = "percent of span",
        .parameters =
            {
                {.name = "GAIN",
                 .label = "GAIN",
                 .unit = "%/%",
                 .role = ParameterRole::gain,
                 .term = kKn,
                 .range = {0, kUnbounded}},
                {.name = "RESET",
                 .label = "RESET",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = {0, kUnbounded}},
                {.name = "RATE",
                 .label = "RATE",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kUnbounded}},
                deltav_alpha(),
                fixed_choice("FORM", "FORM", std::string("Standard")),
                deltav_structure(),
                {.name = "BETA",
                 .label = "BETA",
                 .role = ParameterRole::weight_b,
                 .shape = Shape::weight,
                 .range = kShare,
                 .remark = "has an effect only with STRUCTURE two degrees of freedom"},
                {.name = "GAMMA",
                 .label = "GAMMA",
                 .role = ParameterRole::weight_c,
                 .shape = Shape::weight,
                 .range = kShare,
                 .remark = "has an effect only with STRUCTURE two degrees of freedom"},
            },
        .filter = {FilterKind::parameter, 0, "First order, ALPHA RATE, ALPHA from 0.05 to 1."},
        .weights = {1, 0, "STRUCTURE sets both; with two degrees of freedom they are BETA and GAMMA."},
        .action = kDeltaVAction,
        .algorithm = deltav_algorithm(),
        .traps = {"Provox settings (series, repeats per minute, minutes) made loops oscillate if only their units "
                  "were converted.",
                  "The limits of the anti-reset windup are in engineering units."},
        .evidence = deltav_evidence({"both forms, Standard as the default", "units", "range and default of ALPHA",
                                     "rule of the windup limits", "formulas from series to standard"},
                                    {"printed transfer functions", "exact position of ALPHA in the Standard form"}),
        .example = of_design_a({{"GAIN", 3.0},
                                {"RESET", 120.0},
                                {"RATE", 20.0},
                                {"ALPHA", 0.1},
                                {"FORM", std::string("Standard")},
                                {"STRUCTURE", std::string("Two degrees of freedom controller")},
                                {"BETA", 0.6},
                                {"GAMMA", 0.0}}),
        .scheduling = kDeltaVScheduling,
    };
}

Product deltav_series() {
    return {
        .id = "emerson_deltav_series",
        .maker = "Emerson",
        .name = "DeltaV PID, FORM Series",
        .families = {"DeltaV", "Fisher-Rosemount"},
        .form = Form::series,
        .law = "OUT = GAIN (1 + 1/(RESET s)) (SP - ((RATE s + 1)/(ALPHA RATE s + 1)) PV)",
        .gain_basis = "percent of span",
        .parameters =
            {
                {.name = "GAIN",
                 .label = "GAIN",
                 .unit = "%/%",
                 .role = ParameterRole::gain,
                 .term = kKn,
                 .range = {0, kUnbounded}},
                {.name = "RESET",
                 .label = "RESET",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = {0, kUnbounded}},
                {.name = "RATE",
                 .label = "RATE",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kUnbounded}},
                deltav_alpha(),
                fixed_choice("FORM", "FORM", std::string("Series")),
                fixed_choice("STRUCTURE", "STRUCTURE", std::string(kOwnStructure),
                             "the default; how the others act in this form is not known"),
            },
        .series_alpha = kDeltaVAlpha,
        .filter = {FilterKind::parameter, 0,
                   "The filter covers the whole lead, with ALPHA RATE; settings are computed "
                   "for ALPHA 0.125."},
        .weights = {1, 0, "The lead acts on the measurement, which makes b = RESET/Ti and c = 0."},
        .action = kDeltaVAction,
        .algorithm = deltav_algorithm(),
        .traps = {"Settings of the ideal form act here as GAIN (1 + RATE/RESET), RESET + RATE and a shorter rate.",
                  "The maker's own conversion formulas omit ALPHA."},
        .evidence =
            deltav_evidence({"formulas from series to standard, without ALPHA", "units", "range and default of ALPHA"},
                            {"printed equation", "structures other than the default"}),
        .example = of_design_a({{"GAIN", 2.32793},
                                {"RESET", 93.1174},
                                {"RATE", 30.723},
                                {"ALPHA", 0.125},
                                {"FORM", std::string("Series")},
                                {"STRUCTURE", std::string(kOwnStructure)}}),
        .scheduling = kDeltaVScheduling,
    };
}

const Action kHoneywellAction{.kind = Action::Kind::switched,
                              .name = "CTLACTN",
                              .direct = std::string("DIRECT"),
                              .reverse = std::string("REVERSE"),
                              .text = "CTLACTN sets the direction."};

std::vector<Parameter> honeywell_parameters(Parameter equation) {
    return {
        {.name = "K", .label = "K", .unit = "%/%", .role = ParameterRole::gain, .term = kKn, .range = {0, kUnbounded}},
        {.name = "T1",
         .label = "T1",
         .unit = "min",
         .role = ParameterRole::integral,
         .term = times(kMinutes, kTi),
         .range = {0, kUnbounded}},
        {.name = "T2",
         .label = "T2",
         .unit = "min",
         .role = ParameterRole::derivative,
         .term = times(kMinutes, kTd),
         .range = {0, kUnbounded}},
        std::move(equation)};
}

Product honeywell_interactive() {
    constexpr double kLeadRatio = 0.1;
    return {
        .id = "honeywell_interactive_b",
        .maker = "Honeywell",
        .name = "TDC 3000 / Experion PID, interactive, equation B",
        .families = {"Experion PKS", "TDC 3000", "TPS"},
        .form = Form::series,
        .law = "CV = K (1 + 1/(T1 s)) (SP - ((T2 s + 1)/(0.1 T2 s + 1)) PV)",
        .gain_basis = "percent of span",
        .parameters = honeywell_parameters(
            fixed_choice("equation", "CTLEQN", std::string("B"), "C would remove the set point from P as well.")),
        .filter = {FilterKind::ratio, kLeadRatio, "The lead's ratio is 0.1 and cannot be set: Tf = 0.1 T2."},
        .weights = {1, 0,
                    "Equation B has its derivative on the measurement, which makes b = T1/Ti; equation C has "
                    "b = 0."},
        .action = kHoneywellAction,
        .algorithm = {.velocity = true,
                      .published = false,
                      .text = "incremental algorithm (believed)",
                      .anti_windup = "limits and windup status",
                      .sample_time_text = "not known"},
        .traps = {"In PID B of a UDC controller only the integral acts on the set point: that is equation C here."},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"equation B with 0.1, minutes, percent, as a forum quotes the reference book",
                              "UDC 3300: PID A on the error, PID B with the set point in the integral alone"},
                     .unverified = {"equations A, C, D and E", "Experion's own text", "discrete algorithm"},
                     .sources = {"control.com thread 4738, Honeywell PID equation (forum)",
                                 "Honeywell UDC 3300 manual p. 105"}},
        .example = of_design_a({{"K", 2.33739}, {"T1", 1.55826}, {"T2", 0.490825}, {"equation", std::string("B")}}),
    };
}

Product honeywell_ideal() {
    Parameter equation{.name = "equation",
                       .label = "CTLEQN",
                       .role = ParameterRole::choice,
                       .shape = Shape::option,
                       .options = {{.value = std::string("B"), .b = 1, .c = 0},
                                   {.value = std::string("A"), .b = 1, .c = 1},
                                   {.value = std::string("C"), .b = 0, .c = 0}},
                       .remark =
                           "A: all parts act on the error. B: D acts on the measurement. C: P and D act on the "
                           "measurement."};
    return {
        .id = "honeywell_ideal",
        .maker = "Honeywell",
        .name = "TDC 3000 / Experion PID, ideal, equations A to C",
        .families = {"Experion PKS", "TDC 3000", "TPS"},
        .form = Form::ideal,
        .law = "CV = K [ (b SP - PV) + (1/(T1 s)) (SP - PV) + T2 s (c SP - PV) ]",
        .gain_basis = "percent of span",
        .parameters = honeywell_parameters(std::move(equation)),
        .filter = {FilterKind::unknown, 0, "The block filters its derivative by a fixed ratio that is not known."},
        .weights = {1, 0, "The equation sets both: A 1 and 1, B 1 and 0, C 0 and 0."},
        .action = kHoneywellAction,
        .algorithm = {.velocity = true,
                      .published = false,
                      .text = "incremental algorithm (believed)",
                      .sample_time_text = "not known"},
        .evidence = {.level = EvidenceLevel::unverified, .unverified = {"everything: no manual could be read"}},
        .example = of_design_a({{"K", 3.0}, {"T1", 2.0}, {"T2", 0.333333}, {"equation", std::string("B")}}),
    };
}

}  // namespace

std::vector<Product> emerson_honeywell_products() {
    return {deltav_standard(), deltav_series(), honeywell_interactive(), honeywell_ideal()};
}

}  // namespace tunewright::product
