// Measurement and laboratories: LabVIEW, the epid record of EPICS.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

Product labview() {
    return {
        .id = "labview_pid",
        .maker = "NI",
        .name = "LabVIEW PID / LabWindows PID toolkit",
        .families = {"NI", "National Instruments"},
        .form = Form::ideal,
        .law = "u = Kc [ (beta SP - PV) + (1/(Ti s)) (SP - PV) + Td s (gamma SP - PV) ]",
        .gain_basis = "engineering units; 100/PB where both ranges are in percent",
        .parameters =
            {
                {.name = "Kc", .label = "Kc", .unit = "output/PV unit", .role = ParameterRole::gain, .term = kKp},
                {.name = "Ti_min",
                 .label = "Ti",
                 .unit = "min",
                 .role = ParameterRole::integral,
                 .term = times(kMinutes, kTi),
                 .range = {0, kUnbounded}},
                {.name = "Td_min",
                 .label = "Td",
                 .unit = "min",
                 .role = ParameterRole::derivative,
                 .term = times(kMinutes, kTd),
                 .range = {0, kUnbounded}},
                {.name = "VI",
                 .label = "VI",
                 .role = ParameterRole::choice,
                 .shape = Shape::option,
                 .options = {{.value = std::string("PID.vi"), .b = 1, .c = 0},
                             {.value = std::string("PID Advanced.vi"), .free_weights = true}}},
                {.name = "beta",
                 .label = "beta (PID Advanced)",
                 .role = ParameterRole::weight_b,
                 .shape = Shape::weight,
                 .range = kShare,
                 .standard = 1.0},
                {.name = "gamma",
                 .label = "gamma (PID Advanced)",
                 .role = ParameterRole::weight_c,
                 .shape = Shape::weight,
                 .range = kShare,
                 .standard = 0.0},
            },
        .filter = {FilterKind::none, 0, "None in PID.vi; PID Advanced has alpha, whose scale is not known."},
        .weights = {1, 0, "beta and gamma are those of PID Advanced; PID.vi has 1 and 0."},
        .action = kSigned,
        .algorithm = {.integral = IntegralRule::trapezoidal,
                      .derivative = DerivativeRule::difference,
                      .text = "position algorithm",
                      .anti_windup = "the integral is corrected at the limits of the "
                                     "output, -100 and 100 by default",
                      .sample_time_text = "input dt, or measured"},
        .traps = {"Ti and Td are minutes, although dt is in seconds."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"equations, discretisation", "minutes", "beta and gamma"},
                     .unverified = {"scale of alpha"},
                     .sources = {"NI 371685C p. 10", "NI PID Control Toolkit p. 11",
                                 "unofficial LabVIEW documentation, pid_adv_alg",
                                 "LabVIEW 2012 PID and Fuzzy Logic Toolkit help (excerpt)"}},
        .example = of_design_a({{"Kc", 1.5},
                                {"Ti_min", 2.0},
                                {"Td_min", 0.333333},
                                {"VI", std::string("PID Advanced.vi")},
                                {"beta", 0.6},
                                {"gamma", 0.0}}),
        .scheduling =
            GainScheduling{
                .between = Interpolation::steps,
                .text = "PID Gain Schedule.vi gives PID.vi the Kc, Ti and Td of the first set whose max value the "
                        "scheduling value does not exceed: the max value of a set is the value of the scheduling "
                        "variable at the next row. It has no hysteresis.",
                .source = "NI, LabVIEW API reference, PID Gain Schedule VI"},
    };
}

Product epics() {
    return {
        .id = "epics_epid",
        .maker = "EPICS",
        .name = "epid record (std module, soft)",
        .families = {"EPICS", "IOC"},
        .form = Form::ideal,
        .law = "OVAL = KP [ e + (KI/s) e + KD s e ], e = VAL - CVAL",
        .gain_basis = "engineering units",
        .parameters =
            {
                {.name = "KP", .label = "KP", .role = ParameterRole::gain, .term = kKp},
                {.name = "KI",
                 .label = "KI",
                 .unit = "1/s",
                 .role = ParameterRole::integral,
                 .term = {.Ti = -1},
                 .range = {0, kUnbounded},
                 .zero_remark = "KI = 0 does not hold the integral but sets it to DRVL, or to DRVH for a negative KP. "
                                "Set the limits so that this is harmless, or keep a small KI.",
                 .remark = "a reset rate, 1/Ti"},
                {.name = "KD",
                 .label = "KD",
                 .unit = "s",
                 .role = ParameterRole::derivative,
                 .term = kTd,
                 .range = {0, kUnbounded}},
                {.name = "MDT",
                 .label = "MDT",
                 .unit = "s",
                 .role = ParameterRole::limit,
                 .shape = Shape::constant,
                 .elsewhere = true,
                 .remark = "smallest interval between two computations"},
            },
        .filter = {FilterKind::none},
        .weights = {1, 1, "All three parts act on the error."},
        .action = kSigned,
        .algorithm = {.derivative = DerivativeRule::difference,
                      .text = "position algorithm",
                      .anti_windup = "at DRVH and DRVL the integral does not grow, and it stays between them",
                      .sample_time_text = "the scan, at least MDT; measured"},
        .traps = {"KI = 0 does not hold the integral but sets it to DRVL.", "It computes in single precision."},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"do_pid", "fields and units in the record's manual", "records in a database file"},
                     .sources = {"epics-modules/std stdApp/src/devEpidSoft.c, docs/epidRecord.md at 0abc7aa5"}},
        .example = of_design_a({{"KP", 1.5}, {"KI", 0.00833333}, {"KD", 20.0}}),
        .snippets = {{"IOC shell, for the record loop",
                      "dbpf loop.KP {KP}\n"
                      "dbpf loop.KI {KI}\n"
                      "dbpf loop.KD {KD}"},
                     {"Database, for the record loop",
                      "record(epid, \"loop\") {{\n"
                      "    field(KP, \"{KP}\")\n"
                      "    field(KI, \"{KI}\")\n"
                      "    field(KD, \"{KD}\")\n"
                      "}"}},
    };
}

}  // namespace

std::vector<Product> laboratory_products() { return {labview(), epics()}; }

}  // namespace tunewright::product
