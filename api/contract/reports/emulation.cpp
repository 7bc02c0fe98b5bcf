#include "engine/tuning/emulation/emulation_report.h"

#include "api/contract/reports/reports.h"

#include "api/contract/controller.h"
#include "api/contract/plant/plant.h"
#include "api/describe/answers.h"

namespace tunewright::api {
namespace {

// A text, left out if it is empty.
Codec<std::string> words_if_any() {
    return unless<std::string>(words(), [](const std::string& value) { return value.empty(); });
}

Codec<std::vector<double>> trace_if_any() {
    return unless<std::vector<double>>(trace(), [](const std::vector<double>& values) { return values.empty(); });
}

using Values = std::map<std::string, double>;

Codec<Values> values(const char* keys) { return numbers_by_name(keys); }

Codec<Values> values_if_any(const char* keys) {
    return unless<Values>(values(keys), [](const Values& map) { return map.empty(); });
}

void write_pair(double first, double second, Writer& out) {
    out.begin_array();
    out.number(first);
    out.number(second);
    out.end_array();
}

Json pair_of_numbers() {
    return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
}

Codec<std::map<std::string, NumberRange>> ranges() {
    return {{},
            [](const std::map<std::string, NumberRange>& map, Writer& out) {
                out.begin_object();
                for (const auto& [name, range] : map) {
                    out.key(name);
                    write_pair(range.low, range.high, out);
                }
                out.end_object();
            },
            [](SchemaBook&) {
                return Json{{"type", "object"},
                            {"description", "Symbol of the parameter."},
                            {"additionalProperties", pair_of_numbers()}};
            }};
}

Codec<std::vector<std::complex<double>>> complex_numbers() {
    return {{},
            [](const std::vector<std::complex<double>>& numbers, Writer& out) {
                out.begin_array();
                for (const auto& z : numbers)
                    z.imag() == 0 ? out.number(z.real()) : write_pair(z.real(), z.imag(), out);
                out.end_array();
            },
            [](SchemaBook&) {
                return Json{{"type", "array"},
                            {"items", {{"oneOf", Json::array({Json{{"type", "number"}}, pair_of_numbers()})}}}};
            }};
}

const Description<ActiveBound>& active_bound_contract() {
    static const auto description = [] {
        Description<ActiveBound> d("ActiveBound", "A bound on which the optimum lies.");
        d.field("parameter", &ActiveBound::parameter, words(), "Kp, Ti, Td or Tf.")
            .field(
                "bound", {}, [](const ActiveBound& at, Writer& out) { out.text(at.high ? "high" : "low"); },
                [](SchemaBook&) {
                    return Json{{"type", "string"}, {"enum", {"low", "high"}}};
                },
                "The end of the bound.")
            .field("value", &ActiveBound::value, only_answered(number()), "Its value.");
        return d;
    }();
    return description;
}

const Description<EmulationFit>& fit_contract() {
    static const auto description = [] {
        using F = EmulationFit;
        Description<F> d("EmulationFit",
                         "Part of the nonlinear controller's action that the PID does not reproduce (Remark 7).");
        d.field("u_left", &F::u_left, only_answered(number()),
                "int (u_nl - u)^2 dt over int (u_nl - u_rest)^2 dt, mean over the scenarios.")
            .field("y_left", &F::y_left, only_answered(number()),
                   "int (y_nl - y)^2 dt over int (y_nl - y_rest)^2 dt, mean over the scenarios.")
            .field("adequate", &F::adequate, only_answered(boolean()), "True if a PID is sufficient.")
            .field("sentence", &F::sentence, words(), "The conclusion with its figure.");
        return d;
    }();
    return description;
}

const Description<LevelOneRow>& level_one_contract() {
    static const auto description = [] {
        using R = LevelOneRow;
        Description<R> d("LevelOneRow",
                         "Classical settings for comparison with the emulating ones, on the same plant and scenario.");
        d.field("method", &R::method, words(), "Id of the method.")
            .field(
                "test", {}, [](const R& row, Writer& out) { out.text(row.test); },
                [](SchemaBook&) {
                    return Json{{"type", "string"}, {"enum", {"step", "relay", "linear"}}};
                },
                "Source of its model: a simulated step test, a simulated relay test, the linearisation.")
            .field("title", &R::title, words(), "Its name.")
            .field("model", &R::model, maybe(only_answered(one_of(plant_contract()))), "Model for the rule.")
            .field("controller", &R::controller, maybe(only_answered(one_of(controller_contract()))), "The settings.")
            .field("error", &R::error, words_if_any(), "Reason why there are none.")
            .field("J", &R::J, nullable_number(), "J with these settings.")
            .field("ended", &R::ended, words_if_any(), "Reason why its run ended before the horizon.")
            .field("t", &R::t, abscissa_if_any(), "Time, first scenario.", {.unit = "time"})
            .field("y", &R::y, trace_if_any(), "Output, absolute.", {.unit = "y"})
            .field("u", &R::u, trace_if_any(), "Input, absolute.", {.unit = "u"})
            .why_null("There is no run to the horizon.");
        return d;
    }();
    return description;
}

const Description<EmulatedScenario>& scenario_contract() {
    static const auto description = [] {
        using S = EmulatedScenario;
        Description<S> d("EmulatedScenario", "One of the runs over which the optimum is averaged; y and u absolute.");
        d.field("setpoint_step", &S::setpoint_step, only_answered(number()), "Set-point step from the steady state.",
                {.unit = "y"})
            .field("initial", &S::initial, values_if_any("State."), "States at t = 0; the others are steady.")
            .field("parameters", &S::parameters, values_if_any("Parameter."), "Other values of the plant's parameters.")
            .field("y_rest", &S::y_rest, only_answered(number()), "Output at its steady state.", {.unit = "y"})
            .field("u_rest", &S::u_rest, only_answered(number()), "Input there.", {.unit = "u"})
            .field("limited", &S::limited, only_answered(boolean()), "True if limits clip the nonlinear controller.")
            .field("ended", &S::ended, words_if_any(), "Reason why the PID's run ended before the horizon.")
            .field("t", &S::t, abscissa_if_any(), "Time.", {.unit = "time"})
            .field("y_nl", &S::y_nl, trace_if_any(), "Output under the nonlinear controller.", {.unit = "y"})
            .field("u_nl", &S::u_nl, trace_if_any(), "Input under it.", {.unit = "u"})
            .field("y", &S::y, trace_if_any(), "Output under the PID.", {.unit = "y"})
            .field("u", &S::u, trace_if_any(), "Input under it.", {.unit = "u"});
        return d;
    }();
    return description;
}

// A trace of the first scenario, at the entry's own level.
void first_scenario(Description<EmulationReport>& d, const char* name, std::vector<double> EmulatedScenario::*member,
                    const char* sentence, const char* unit) {
    d.field(
        name, {},
        [member](const EmulationReport& report, Writer& out) { trace().write(report.scenarios.front().*member, out); },
        member == &EmulatedScenario::t ? abscissa().schema : trace().schema, sentence, {.unit = unit},
        [member](const EmulationReport& report) {
            return report.scenarios.empty() || (report.scenarios.front().*member).empty();
        });
}

void add_criterion(Description<EmulationReport>& d) {
    using R = EmulationReport;
    d.field("formulation", &R::formulation, words(), "full or remark6.")
        .field("J", &R::J, only_answered(number()), "wy J_y + wu J_u, mean over the scenarios.")
        .field("J_y", &R::J_y, nullable_number(), "int (y_nl - y)^2 dt.", {.unit = "y^2 time"})
        .field("J_u", &R::J_u, only_answered(number()), "int (u_nl - u)^2 dt.", {.unit = "u^2 time"})
        .field(
            "weights", {},
            [](const R& report, Writer& out) {
                out.begin_object();
                out.key("wy").number(report.wy);
                out.key("wu").number(report.wu);
                out.end_object();
            },
            [](SchemaBook&) {
                return Json{{"type", "object"},
                            {"properties", {{"wy", {{"type", "number"}}}, {"wu", {{"type", "number"}}}}}};
            },
            "Weights of the two parts.")
        .field("horizon", &R::horizon, only_answered(number()), "End of the integrals.", {.unit = "time"});
}

const Description<EmulationReport>& emulation_contract() {
    static const auto description = [] {
        using R = EmulationReport;
        Description<R> d("Emulation", "Comparison of the PID with the nonlinear controller, and the search for it.");
        add_criterion(d);
        d.field("active_bounds", &R::active_bounds, list_of(answer(active_bound_contract())), "Active bounds.")
            .field("bounds", &R::bounds, ranges(), "Bounds of the search.")
            .field("flatness", &R::flatness, values("Symbol of the parameter."),
                   "Change of one parameter that increases J by 5 %, with the others re-optimised.")
            .field("flatness_alone", &R::flatness_alone, values("Symbol of the parameter."),
                   "Change of one parameter that increases J by 5 %, with the others fixed.")
            .field("relative_degree", &R::relative_degree, only_answered(integer(1, 100)),
                   "Relative degree: order of the first derivative of y that depends on u.")
            .field("zero_dynamics_stable", &R::zero_dynamics_stable, only_answered(boolean()),
                   "True if all zeros of the linearisation are in the open left half-plane.")
            .field("zeros", &R::zeros, complex_numbers(), "Zeros of the linearisation.", {.unit = "1/time"})
            .field(
                "target", {},
                [](const R& report, Writer& out) {
                    out.begin_object();
                    out.key("beta").begin_array();
                    for (const double beta : report.beta) out.number(beta);
                    out.end_array();
                    out.end_object();
                },
                [](SchemaBook&) {
                    return Json{{"type", "object"},
                                {"properties", {{"beta", {{"type", "array"}, {"items", {{"type", "number"}}}}}}}};
                },
                "beta_r y^(r) + ... + beta_1 y' + beta_0 y = set point under the nonlinear controller.")
            .field("fit", &R::fit, answer(fit_contract()), "Remark 7.")
            .field("level1", &R::level1, list_of(answer(level_one_contract())), "The first level.")
            .field("scenarios", &R::scenarios, list_of(answer(scenario_contract())), "The second level's runs.");
        first_scenario(d, "t", &EmulatedScenario::t, "Time of the first scenario.", "time");
        first_scenario(d, "y_nl", &EmulatedScenario::y_nl, "Its output under the nonlinear controller, absolute.", "y");
        first_scenario(d, "u_nl", &EmulatedScenario::u_nl, "Its input, absolute.", "u");
        d.why_null("Remark 6 leaves the output out.");
        return d;
    }();
    return description;
}

}  // namespace

ReportContract emulation_report() {
    return report_contract("emulation", emulation_contract(),
                           "For the method emulation: both levels, and the nonlinear controller's own run.", true);
}

}  // namespace tunewright::api
