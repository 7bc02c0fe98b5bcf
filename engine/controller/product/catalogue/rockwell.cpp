// Rockwell Automation: the PID and PIDE instructions of Logix 5000, and the integer PID of SLC 500 and MicroLogix.
#include "engine/controller/product/catalogue/terms.h"

namespace tunewright::product {
namespace {

/// The controllers that run Logix 5000.
std::vector<std::string_view> logix_families() {
    return {"ControlLogix", "CompactLogix", "GuardLogix", "Studio 5000", "RSLogix 5000", "Allen-Bradley"};
}

constexpr std::string_view kSmoothing = "None; the time constant of the optional smoothing was not found.";

Parameter gain(std::string_view name, std::string_view label, std::string_view unit) {
    return {
        .name = name, .label = label, .unit = unit, .role = ParameterRole::gain, .term = kKn, .range = {0, kUnbounded}};
}

Parameter action_of(std::string_view name, std::string_view label, std::string_view unit, ParameterRole role,
                    Term term) {
    return {.name = name, .label = label, .unit = unit, .role = role, .term = term, .range = {0, kUnbounded}};
}

// ---- PID

Product logix_pid() {
    return {
        .maker = "Rockwell",
        .families = logix_families(),
        .gain_basis = "percent of span",
        .filter = {FilterKind::none, 0, kSmoothing},
        .weights = {1, 0, "P acts on the error; D acts on the measurement (.DOE 0) or the error (.DOE 1)."},
        .action = {.kind = Action::Kind::switched,
                   .name = "CA",
                   .direct = 1.0,
                   .reverse = 0.0,
                   .text = ".CA chooses SP - PV or PV - SP as the error."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .published = false,
                      .text = "position algorithm with bias; the derivative is a difference",
                      .anti_windup = "limits .MAXO and .MINO; the integral is held at them (unverified)",
                      .sample_time_text = ".UPD, the loop's update time"},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"both equations in four variants", "units of the gains in both modes", ".DOE, .CA, .PE"},
                     .unverified = {"constant of the smoothing", "discrete rule", "meaning of 0 in .KI when dependent"},
                     .sources = {"1756-RM003N p. 519", "Studio 5000 Logix Designer 37 help, specifying tuning",
                                 "FactoryTalk Design Studio help, PID instructions"}},
        .snippets = {{"Structured text, for the tag Loop",
                      "Loop.KP := {KP};\n"
                      "Loop.KI := {KI};\n"
                      "Loop.KD := {KD};\n"
                      "Loop.PE := {PE=1.00:1/0};\n"
                      "Loop.DOE := {DOE=1:1/0};\n"
                      "Loop.CA := {CA=1:1/0};"}},
    };
}

Parameter derivative_of_error() {
    return {.name = "DOE",
            .label = ".DOE",
            .role = ParameterRole::choice,
            .shape = Shape::option,
            .options = {{.value = 0.0, .c = 0}, {.value = 1.0, .c = 1}},
            .remark = "0: of the measurement; 1: of the error."};
}

Product pid_independent() {
    Product product = logix_pid();
    product.id = "rockwell_pid_independent";
    product.name = "Logix PID, independent gains (.PE 0)";
    product.form = Form::parallel;
    product.law = "CV = KP e + (KI/s) e + KD s (c SP - PV) + bias, e = SP - PV";
    product.parameters = {gain("KP", ".KP", ""), action_of("KI", ".KI", "1/s", ParameterRole::integral, of_spans(kKi)),
                          action_of("KD", ".KD", "s", ParameterRole::derivative, of_spans(kKd)),
                          fixed_choice("PE", ".PE", 0.0, "0: independent gains"), derivative_of_error()};
    product.traps = {".KI holds 1/s here and minutes per repeat in dependent mode."};
    product.example = of_design_a({{"KP", 3.0}, {"KI", 0.025}, {"KD", 60.0}, {"PE", 0.0}, {"DOE", 0.0}});
    return product;
}

Product pid_dependent() {
    Product product = logix_pid();
    product.id = "rockwell_pid_dependent";
    product.name = "Logix PID, dependent gains (.PE 1)";
    product.form = Form::ideal;
    product.law = "CV = KP [ e + (1/(KI s)) e + KD s (c SP - PV) ] + bias, e = SP - PV";
    product.parameters = {gain("KP", ".KP", ""),
                          action_of("KI", ".KI", "min", ParameterRole::integral, times(kMinutes, kTi)),
                          action_of("KD", ".KD", "min", ParameterRole::derivative, times(kMinutes, kTd)),
                          fixed_choice("PE", ".PE", 1.0, "1: dependent gains"), derivative_of_error()};
    product.traps = {"Seconds typed for minutes are wrong by a factor of 60.",
                     "A larger .KI makes the loop slower here, but faster with independent gains."};
    product.example = of_design_a({{"KP", 3.0}, {"KI", 2.0}, {"KD", 0.333333}, {"PE", 1.0}, {"DOE", 0.0}});
    return product;
}

// ---- PID of integer words

Product slc() {
    constexpr double kTenths = 100;  // scale of the gain with RG = 1, and always of Td: steps of 0.01
    return {
        .id = "rockwell_slc_pid",
        .maker = "Rockwell",
        .name = "SLC 500 / MicroLogix PID (integer words, RG 1)",
        .families = {"SLC 500", "MicroLogix", "RSLogix 500", "Allen-Bradley"},
        .form = Form::ideal,
        .law = "CV = (KC/100) [ e + (1/(0.6 TI s)) e - 0.6 TD s PV ], e = SP - PV",
        .gain_basis = "percent of span",
        .parameters =
            {
                {.name = "KC_RG1",
                 .label = "KC",
                 .unit = "x 0.01",
                 .role = ParameterRole::gain,
                 .term = times(kTenths, kKn),
                 .range = {1, kMaxSignedWord},
                 .resolution = kWholeNumber,
                 .remark = "with RG = 0 in steps of 0.1"},
                {.name = "TI_RG1",
                 .label = "TI",
                 .unit = "x 0.01 min",
                 .role = ParameterRole::integral,
                 .term = times(kTenths / 60, kTi),
                 .range = {1, kMaxSignedWord},
                 .resolution = kWholeNumber,
                 .remark = "with RG = 0 in steps of 0.1 min"},
                {.name = "TD",
                 .label = "TD",
                 .unit = "x 0.01 min",
                 .role = ParameterRole::derivative,
                 .term = times(kTenths / 60, kTd),
                 .range = {0, kMaxSignedWord},
                 .resolution = kWholeNumber},
                fixed_choice("RG", "RG", 1.0, "the range of KC and TI: 1 for steps of 0.01"),
            },
        .filter = {FilterKind::unknown, 0, "Whether the derivative is filtered is not known."},
        .weights = {1, 0, "P acts on the error, D on the measurement."},
        .action = {.kind = Action::Kind::switched,
                   .name = "CM",
                   .direct = 1.0,
                   .reverse = 0.0,
                   .text = "The control mode bit sets the error's sign."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .published = false,
                      .text = "position algorithm",
                      .anti_windup = "limits of the output",
                      .sample_time_text = "the word of the loop's update time"},
        .traps = {"Ti and Td go in steps of 0.6 s: a Td of 1 s becomes 2 counts, 1.2 s."},
        .evidence = {.level = EvidenceLevel::partly,
                     .read = {"ranges and units of the words", "bit RG"},
                     .unverified = {"text of the equation", "filter", "discrete algorithm",
                                    "name of the direction's bit"},
                     .sources = {"1747-RM001G p. 178", "1762-RM001C p. 251"}},
        .example = of_design_a({{"KC_RG1", 300.0}, {"TI_RG1", 200.0}, {"TD", 33.0}, {"RG", 1.0}}),
    };
}

// ---- PIDE

Product pide() {
    return {
        .maker = "Rockwell",
        .families = logix_families(),
        .gain_basis = "percent of span (PVEUMin..PVEUMax, CVEUMin..CVEUMax)",
        .filter = {FilterKind::none, 0, "None; the time constant of the option DSmoothing was not found."},
        .weights = {1, 0, "PVEProportional removes the set point from P, PVEDerivative from D."},
        .action = {.kind = Action::Kind::switched,
                   .name = "ControlAction",
                   .direct = true,
                   .reverse = false,
                   .text = "ControlAction sets the error's sign."},
        .algorithm = {.derivative = DerivativeRule::difference,
                      .velocity = true,
                      .text = "velocity algorithm: increments of the error, error times dt, second difference",
                      .anti_windup = "none needed within the limits of CV: only increments are added",
                      .sample_time_text = "the task's period, OversampleDT or RTS"},
        .evidence = {.level = EvidenceLevel::read,
                     .read = {"units of all gains in both forms", "dt in seconds, error in percent of span",
                              "P of the error and D of the measurement as defaults"},
                     .unverified = {"printed difference equation", "constant of DSmoothing",
                                    "default of the form's selector"},
                     .sources = {"1756-RM006K pp. 71, 80, 81"}},
        .snippets = {{"Structured text, for the tag Loop",
                      "Loop.PGain := {PGain};\n"
                      "Loop.IGain := {IGain};\n"
                      "Loop.DGain := {DGain};\n"
                      "Loop.DependIndepend := {DependIndepend=true:1/0};\n"
                      "Loop.PVEProportional := {PVEProportional=true:1/0};\n"
                      "Loop.PVEDerivative := {PVEDerivative=true:1/0};\n"
                      "Loop.ControlAction := {ControlAction=true:1/0};"}},
    };
}

std::vector<Parameter> pide_switches() {
    return {{.name = "PVEProportional",
             .label = "PVEProportional",
             .role = ParameterRole::choice,
             .shape = Shape::option,
             .options = {{.value = false, .b = 1}, {.value = true, .b = 0}}},
            {.name = "PVEDerivative",
             .label = "PVEDerivative",
             .role = ParameterRole::choice,
             .shape = Shape::option,
             .options = {{.value = true, .c = 0}, {.value = false, .c = 1}}}};
}

Product pide_of(Form form, std::vector<Parameter> parameters) {
    Product product = pide();
    product.form = form;
    product.parameters = std::move(parameters);
    product.parameters.push_back(
        fixed_choice("DependIndepend", "DependIndepend", form == Form::ideal, "true: dependent gains"));
    for (Parameter& choice : pide_switches()) product.parameters.push_back(std::move(choice));
    return product;
}

Product pide_independent() {
    Product product =
        pide_of(Form::parallel,
                {gain("PGain", "PGain", "%/%"),
                 action_of("IGain", "IGain", "1/min", ParameterRole::integral, times(kPerMinute, of_spans(kKi))),
                 action_of("DGain", "DGain", "min", ParameterRole::derivative, times(kMinutes, of_spans(kKd)))});
    product.id = "rockwell_pide_independent";
    product.name = "Logix PIDE, independent gains";
    product.law = "CV = PGain (b SP - PV) + (IGain/(60 s)) (SP - PV) + 60 DGain s (c SP - PV)";
    product.traps = {"PID counts in 1/s and s, PIDE in 1/min and min.",
                     "A third party states the gain per engineering unit, the maker in percent of span."};
    product.example = of_design_a({{"PGain", 3.0},
                                   {"IGain", 1.5},
                                   {"DGain", 1.0},
                                   {"DependIndepend", false},
                                   {"PVEProportional", false},
                                   {"PVEDerivative", true}});
    return product;
}

Product pide_dependent() {
    Product product =
        pide_of(Form::ideal, {gain("PGain", "PGain", "%/%"),
                              action_of("IGain", "IGain", "min", ParameterRole::integral, times(kMinutes, kTi)),
                              action_of("DGain", "DGain", "min", ParameterRole::derivative, times(kMinutes, kTd))});
    product.id = "rockwell_pide_dependent";
    product.name = "Logix PIDE, dependent gains";
    product.law = "CV = PGain [ (b SP - PV) + (1/(60 IGain s)) (SP - PV) + 60 DGain s (c SP - PV) ]";
    product.traps = {"The form decides whether a larger IGain gives more or less integral action."};
    product.example = of_design_a({{"PGain", 3.0},
                                   {"IGain", 2.0},
                                   {"DGain", 0.333333},
                                   {"DependIndepend", true},
                                   {"PVEProportional", false},
                                   {"PVEDerivative", true}});
    return product;
}

}  // namespace

std::vector<Product> rockwell_products() {
    return {pid_independent(), pid_dependent(), slc(), pide_independent(), pide_dependent()};
}

}  // namespace tunewright::product
