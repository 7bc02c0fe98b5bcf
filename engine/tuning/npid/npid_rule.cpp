#include "engine/tuning/npid/npid_rule.h"

#include <cmath>

#include "engine/number_text.h"
#include "engine/tuning/npid/npid_optimum.h"

namespace tunewright {
namespace {

struct Coefficients {
    double a1, b1, a2, b2, a3, b3;
};

struct Rule {
    ErrorCriterion criterion;
    const char *id, *index;
    Coefficients short_delay;  // Table 2
    Coefficients long_delay;   // Table 3
};

constexpr double kTable2To = 0.9, kTable3From = 1, kLowest = 0.01, kHighest = 3;

constexpr Rule kISE = {ErrorCriterion::ISE,
                       "npid_ise",
                       "ISE",
                       {1.2886, -0.9182, 0.9217, 0.2375, 0.4302, 0.9645},
                       {1.3362, -0.5488, 0.8419, 0.3190, 0.4137, 0.75}};
constexpr Rule kIAE = {ErrorCriterion::IAE,
                       "npid_iae",
                       "IAE",
                       {1.0350, -0.9327, 0.9465, 0.1398, 0.3527, 0.9406},
                       {1.0822, -0.5495, 0.8237, 0.2692, 0.3331, 0.6831}};
constexpr Rule kITAE = {ErrorCriterion::ITAE,
                        "npid_itae",
                        "ITAE",
                        {1.0019, -0.9457, 0.8723, 0.1848, 0.3401, 0.9799},
                        {1.0093, -0.5198, 0.7813, 0.2781, 0.2878, 0.7317}};

IdealPid settings(const Coefficients& c, double K, double T, double L) {
    const double q = L / T;
    return {.Kp = c.a1 * std::pow(q, c.b1) / K, .Ti = T * (c.a2 + c.b2 * q), .Td = T * c.a3 * std::pow(q, c.b3)};
}

std::optional<Error> unfit(const ReducedModel& model) {
    if (model.integrators > 0)
        return degenerate("plant",
                          "The rule is written for a stable first-order lag with dead time, but this plant integrates.",
                          "Use optimise = true, which needs no model, or simc or robust.");
    if (model.L <= 0)
        return degenerate("plant/L", "The rule raises L/T to a negative power, but the dead time of the model is 0.",
                          "Give the true dead time of the loop, or use lambda or robust.");
    if (model.T1 <= 0)
        return degenerate("plant/T", "The rule divides by the lag T, but that of the model is 0 (a pure dead time).",
                          "Use optimise = true, or amigo or robust.");
    return std::nullopt;
}

std::vector<Warning> remarks(double q) {
    std::vector<Warning> warnings;
    if (q < kLowest || q > kHighest)
        warnings.push_back(outside_validity("L/T is " + text(q) +
                                            ", outside the range 0.01 to 3 for which the rule was fitted. optimise = "
                                            "true finds the plant's own optimum."));
    if (q > kTable2To)
        warnings.push_back(
            {"rule-table", "L/T is " + text(q) + ", above 0.9: the source's table for long dead times is used" +
                               (q < kTable3From ? ". Between 0.9 and 1, for which the source has no table, it costs "
                                                  "less than the other one."
                                                : ".")});
    return warnings;
}

Expected<TunedController> by_rule(const Rule& rule, const TuningProblem& problem, const NpidOptions& options) {
    const auto model = rule_model(problem, options.reduction, {.preferred = ReductionMethod::min_iae});
    if (!model) return model.error();
    if (auto error = unfit(*model)) return *error;
    const double q = model->L / model->T1;
    IdealPid pid = settings(q <= kTable2To ? rule.short_delay : rule.long_delay, model->K, model->T1, model->L);
    pid.filter = chosen_filter(options.filter, FilterType::derivative, pid.Td);
    auto answer = rule_answer(problem, *model, pid, remarks(q));
    if (answer) answer->nonlinear_integral = true;
    return answer;
}

Expected<TunedController> optimised(const Rule& rule, const TuningProblem& problem, const NpidOptions& options,
                                    const RunControl& control) {
    NpidProblem search{problem.linear, rule.criterion, options.filter.Tf_over_Td, options.filter.Tf};
    if (const auto start = by_rule(rule, problem, options)) search.start = start->controller;
    const auto optimum = find_npid_optimum(search, control);
    if (!optimum) return optimum.error();
    TunedController answer;
    answer.controller = optimum->controller;
    answer.nonlinear_integral = true;
    answer.partial = optimum->stopped;
    if (optimum->at_bound)
        answer.warnings.push_back({"at-search-bound",
                                   "The optimum is at the edge of the search region (around the plant's ultimate gain "
                                   "and period); a better one may lie outside."});
    return answer;
}

template <const Rule& rule>
Expected<TunedController> tune(const TuningProblem& problem, const NpidOptions& options, const RunControl& control) {
    if (options.optimise) return optimised(rule, problem, options, control);
    return by_rule(rule, problem, options);
}

std::string formula_of(const Coefficients& c) {
    return "K Kp = " + text(c.a1) + " q^" + text(c.b1) + ", Ti/T = " + text(c.a2) + " + " + text(c.b2) +
           " q, Td/T = " + text(c.a3) + " q^" + text(c.b3);
}

using Solve = Expected<TunedController>(const TuningProblem&, const NpidOptions&, const RunControl&);

TuningMethod described(const Rule& rule, Solve* solve) {
    TuningMethod method;
    method.id = rule.id;
    method.weighs_setpoint = false;
    method.title = std::string("Nonlinear PID, ") + rule.index + " (Jin, Son)";
    method.formula =
        std::string("u = Kp [e + (1/Ti) int exp(-e^2/(2 delta_r^2)) e dt - Td (dy/dt)], q = L/T; q <= 0.9: ") +
        formula_of(rule.short_delay) + "; q > 0.9: " + formula_of(rule.long_delay);
    method.source = "Jin and Son, Studies in Informatics and Control 28 (2019) 157-166, Tables 2 and 3";
    method.needs = "stable fopdt with L > 0 (others are reduced); with optimise any linear plant";
    method.validity = "L/T from 0.01 to 3, set-point steps of the size delta_r; the source has no table for 0.9 to 1";
    OptionSet<NpidOptions> options;
    options.field(&NpidOptions::optimise, "optimise",
                  std::string("Search the settings of least ") + rule.index +
                      " after a set-point step on this plant instead of using the rule's; for any linear plant.");
    add_reduction(options, "min_iae, as the source's fit of the step response; half_rule if that does not apply.");
    add_filter(options, "of the derivative, Td s/(1 + s Tf); none by default, as in the source.");
    method.bind(options, solve);
    return method;
}

}  // namespace

TuningMethod npid_ise_method() { return described(kISE, tune<kISE>); }
TuningMethod npid_iae_method() { return described(kIAE, tune<kIAE>); }
TuningMethod npid_itae_method() { return described(kITAE, tune<kITAE>); }

}  // namespace tunewright
