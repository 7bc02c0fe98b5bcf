// Yokogawa's fieldbus block and CENTUM, Foxboro I/A Series.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

constexpr Range kTimeRange{0.1, 10000};

Product fieldbus() {
    return {
        .id = "yokogawa_ff_pid",
        .maker = "Yokogawa",
        .name = "Fieldbus PID block (YVP110, EJX, AXG, YTA)",
        .form = Form::ideal,
        .law = "OUT = GAIN [ (b SP - PV) + (1/(RESET s)) (SP - PV) - RATE s PV ]",
        .gain_basis = "percent of span (OUT_SCALE over PV_SCALE)",
        .parameters =
            {
                {.name = "GAIN",
                 .label = "GAIN",
                 .unit = "%/%",
                 .role = ParameterRole::gain,
                 .term = kKn,
                 .range = {0.05, 20}},
                {.name = "RESET",
                 .label = "RESET",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = kTimeRange},
                {.name = "RATE",
                 .label = "RATE",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kUnbounded}},
                {.name = "MODE",
                 .label = "mode",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = std::string("Auto"), .b = 0},
                             {.value = std::string("RCas"), .b = 0},
                             {.value = std::string("Cas"), .b = 1}},
                 .elsewhere = true,
                 .remark = "The mode sets the weight; there is no parameter for it."},
            },
        .filter = {FilterKind::none, 0, "No filter is documented."},
        .weights = {0, 0, "The mode sets b: 0 in Auto and RCas, 1 in Cas. Auto is assumed."},
        .action = {.kind = Action::Kind::switched,
                   .name = "Direct Acting",
                   .direct = true,
                   .reverse = false,
                   .text = "Direct Acting is an option in CONTROL_OPTS; the printed formula subtracts and has PV - "
                           "SP."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .velocity = true,
                      .text = "velocity algorithm on the output read back; D is a second difference of PV",
                      .anti_windup = "through the output that is read back",
                      .sample_time_text = "period_of_execution"},
        .traps = {"From Auto to Cas the weight of the set point changes from 0 to 1."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"both equations", "ranges", "scaling and sign"},
                     .sources = {"IM 21B04C01-01E p. 83 (YVP110)", "IM 01E21A02 p. 284 (ADMAG TI AXG)"}},
        .example = of_design_a({{"GAIN", 3.0}, {"RESET", 120.0}, {"RATE", 20.0}, {"MODE", std::string("Auto")}}),
    };
}

Product centum() {
    return {
        .id = "yokogawa_centum_pid",
        .maker = "Yokogawa",
        .name = "CENTUM CS 3000 / VP PID block",
        .families = {"CENTUM VP", "CENTUM CS 3000"},
        .form = Form::ideal,
        .law = "MV = (100/PB) [ (b SV - PV) + (1/(TI s)) (SV - PV) + TD s (c SV - PV) ]",
        .gain_basis = "proportional band in percent of span",
        .parameters =
            {
                {.name = "PB",
                 .label = "P",
                 .unit = "%",
                 .role = ParameterRole::gain,
                 .term = kBand,
                 .range = {0, 1000}},
                {.name = "TI",
                 .label = "I",
                 .unit = "s",
                 .role = ParameterRole::integral,
                 .term = kTi,
                 .range = kTimeRange},
                {.name = "TD",
                 .label = "D",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, 10000}},
                {.name = "type",
                 .label = "control algorithm",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = std::string("PI-D"), .b = 1, .c = 0},
                             {.value = std::string("PID"), .b = 1, .c = 1},
                             {.value = std::string("I-PD"), .b = 0, .c = 0}},
                 .remark = "Another type selects the structure by the mode."},
            },
        .filter = {FilterKind::unknown, 0, "Whether the derivative is filtered is not known."},
        .weights = {1, 0, "The type sets both: PID 1 and 1, PI-D 1 and 0, I-PD 0 and 0."},
        .action = {.kind = Action::Kind::switched,
                   .name = "action",
                   .direct = std::string("direct"),
                   .reverse = std::string("reverse"),
                   .text = "The control action is direct or reverse."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .velocity = true,
                      .published = false,
                      .text = "velocity or position output; differences are believed to be backward",
                      .anti_windup = "limits of the output, read back",
                      .sample_time_text = "1 s basic, 0.2 to 0.5 s medium, 50 to 500 ms fast scan"},
        .traps = {"A larger proportional band is a smaller gain."},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"P = 100/gain, ranges and scan periods, of third parties"},
                     .unverified = {"equation of the CENTUM manual", "filter", "default of the algorithm's type"},
                     .sources = {"CENTUM VP engineering course (scribd 648188231)", "a third party's summary page",
                                 "Yokogawa PID tutorial (scribd 284379932)"}},
        .example = of_design_a({{"PB", 33.3333}, {"TI", 120.0}, {"TD", 20.0}, {"type", std::string("PI-D")}}),
    };
}

Product foxboro() {
    return {
        .id = "foxboro_pid",
        .maker = "Foxboro",
        .name = "I/A Series PID block",
        .families = {"I/A Series", "Foxboro DCS", "Evo"},
        .form = Form::series,
        .law =
            "OUT = (100/PBAND) (1 + 1/(INT s)) (SP - (1 + DERIV s) y), y = PV/(1 + Tf s + (Tf s)^2/2), "
            "1/Tf = KD (1/INT + 1/DERIV)",
        .gain_basis = "proportional band in percent of span",
        .parameters =
            {
                {.name = "PBAND",
                 .label = "PBAND",
                 .unit = "%",
                 .role = ParameterRole::gain,
                 .term = kBand,
                 .range = {0, kUnbounded}},
                {.name = "INT",
                 .label = "INT",
                 .unit = "min",
                 .role = ParameterRole::integral,
                 .term = times(kMinutes, kTi),
                 .range = {0, kUnbounded}},
                {.name = "DERIV",
                 .label = "DERIV",
                 .unit = "min",
                 .role = ParameterRole::derivative,
                 .term = times(kMinutes, kTd),
                 .range = {0, kUnbounded}},
                {.name = "KD",
                 .label = "KD",
                 .role = ParameterRole::filter,
                 .term = {.Tf = -1, .ideal_Td = 1},
                 .range = {0, kUnbounded}},
            },
        .filter =
            {FilterKind::measurement, 0,
             "A second-order Butterworth filter of the whole measurement, Tf = Td/KD with the Td of the ideal form."},
        .weights = {1, 0, "The derivative acts on the measurement, which makes b = INT/Ti."},
        .action = {.kind = Action::Kind::switched,
                   .name = "INCOPT",
                   .direct = true,
                   .reverse = false,
                   .text = "INCOPT sets whether the output increases with the measurement."},
        .algorithm = {.published = false,
                      .text = "position algorithm with external integral feedback",
                      .anti_windup = "integral feedback from BCALCI",
                      .sample_time_text = "the block's period"},
        .traps = {"INT and DERIV are minutes, and PBAND is the inverse of a gain."},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"equations of the modes P, I, PD, PI, PID and of the filter, as a user posted them",
                              "list of features"},
                     .unverified = {"the maker's document", "PIDA, non-interacting (MODOPT)", "discrete algorithm"},
                     .sources = {"mail-archive.com, Foxboro list, message 00393",
                                 "copy of scribd 635124668 (list of features)"}},
        .example = of_design_a({{"PBAND", 42.265}, {"INT", 1.57735}, {"DERIV", 0.42265}, {"KD", 10.0}}),
    };
}

}  // namespace

std::vector<Product> yokogawa_foxboro_products() { return {fieldbus(), centum(), foxboro()}; }

}  // namespace tunewright::product
