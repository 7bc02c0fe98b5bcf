#include "engine/tuning/reaction_curve/error_integral_rules.h"

#include <cmath>
#include <map>

#include "engine/tuning/method/first_order_rule.h"

namespace tunewright {

IdealPid error_integral_settings(const ErrorIntegralRow& row, IntegralLaw law, const ReducedModel& model) {
    const double q = model.L / model.T1;
    IdealPid pid{.Kp = row.a1 * std::pow(q, row.b1) / model.K};
    if (row.a2 != 0)
        pid.Ti = model.T1 * (law == IntegralLaw::power ? std::pow(q, row.b2) / row.a2 : 1 / (row.a2 + row.b2 * q));
    if (row.a3 != 0) pid.Td = model.T1 * row.a3 * std::pow(q, row.b3);
    return pid;
}

const char* to_string(FittedCriterion criterion) {
    switch (criterion) {
        case FittedCriterion::ise: return "ise";
        case FittedCriterion::iae: return "iae";
        case FittedCriterion::itae: return "itae";
        case FittedCriterion::itse: return "itse";
        case FittedCriterion::iste: return "iste";
        case FittedCriterion::istse: return "istse";
    }
    return "";
}

namespace {

using enum ControllerKind;
using enum FittedCriterion;

const std::map<ControllerKind, std::map<FittedCriterion, ErrorIntegralRow>> kLopez{
    {P, {{ise, {1.411, -0.917}}, {iae, {0.902, -0.985}}, {itae, {0.490, -1.084}}}},
    {PI,
     {{ise, {1.305, -0.959, 0.492, 0.739}},
      {iae, {0.984, -0.986, 0.608, 0.707}},
      {itae, {0.859, -0.977, 0.674, 0.680}}}},
    {PID,
     {{ise, {1.495, -0.945, 1.101, 0.771, 0.560, 1.006}},
      {iae, {1.435, -0.921, 0.878, 0.749, 0.482, 1.137}},
      {itae, {1.357, -0.947, 0.842, 0.738, 0.381, 0.995}}}},
};

Expected<TunedController> tune_lopez(const TuningProblem& problem, const LopezOptions& options) {
    const auto& row = kLopez.at(options.controller).at(options.criterion);
    return tune_first_order(
        problem, options.model, {.name = "Lopez", .min = 0.1, .max = 1},
        [&](const ReducedModel& model) { return error_integral_settings(row, IntegralLaw::power, model); });
}

}  // namespace

TuningMethod lopez_method() {
    TuningMethod method;
    method.id = "lopez";
    method.title = "Lopez, load optimum";
    method.formula =
        "Kp = a1 (L/T)^b1/K, Ti = T (L/T)^b2/a2, Td = a3 T (L/T)^b3. PID, IAE: 1.435, -0.921, 0.878, 0.749, 0.482, "
        "1.137; ISE: 1.495, -0.945, 1.101, 0.771, 0.560, 1.006; ITAE: 1.357, -0.947, 0.842, 0.738, 0.381, 0.995. PI, "
        "IAE: 0.984, -0.986, 0.608, 0.707; ISE: 1.305, -0.959, 0.492, 0.739; ITAE: 0.859, -0.977, 0.674, 0.680. P, "
        "IAE: 0.902, -0.985; ISE: 1.411, -0.917; ITAE: 0.490, -1.084";
    method.source = "Lopez, Miller, Smith and Murrill, Instrumentation Technology 14 (1967) 57-62";
    method.needs = "fopdt with T > 0 and L > 0 (others are reduced)";
    method.validity = "L/T from 0.1 to 1; made for load steps, without a limit on Ms";
    OptionSet<LopezOptions> options;
    add_controller(options, {P, PI, PID});
    add_criterion(options, {iae, ise, itae});
    options.embed(&LopezOptions::model, first_order_options());
    method.bind(options, tune_lopez);
    return method;
}

namespace {

const std::map<ControllerKind, std::map<FittedCriterion, ErrorIntegralRow>> kRovira{
    {PI, {{iae, {0.758, -0.861, 1.020, -0.323}}, {itae, {0.586, -0.916, 1.030, -0.165}}}},
    {PID, {{iae, {1.086, -0.869, 0.740, -0.130, 0.348, 0.914}}, {itae, {0.965, -0.850, 0.796, -0.1465, 0.308, 0.929}}}},
};

Expected<TunedController> tune_rovira(const TuningProblem& problem, const RoviraOptions& options) {
    const auto& row = kRovira.at(options.controller).at(options.criterion);
    return tune_first_order(
        problem, options.model, {.name = "Rovira", .min = 0.1, .max = 1},
        [&](const ReducedModel& model) { return error_integral_settings(row, IntegralLaw::line, model); });
}

}  // namespace

TuningMethod rovira_method() {
    TuningMethod method;
    method.id = "rovira";
    method.title = "Rovira, set-point optimum";
    method.formula =
        "Kp = a1 (L/T)^b1/K, Ti = T/(a2 + b2 L/T), Td = a3 T (L/T)^b3. PID, ITAE: 0.965, -0.850, 0.796, -0.1465, "
        "0.308, 0.929; IAE: 1.086, -0.869, 0.740, -0.130, 0.348, 0.914. PI, ITAE: 0.586, -0.916, 1.030, -0.165; IAE: "
        "0.758, -0.861, 1.020, -0.323";
    method.source = "Rovira, Murrill and Smith, Instruments & Control Systems 42 (1969) 67-69";
    method.needs = "fopdt with T > 0 and L > 0 (others are reduced)";
    method.validity = "L/T from 0.1 to 1; made for set-point steps";
    OptionSet<RoviraOptions> options;
    add_controller(options, {PI, PID});
    add_criterion(options, {itae, iae});
    options.embed(&RoviraOptions::model, first_order_options());
    method.bind(options, tune_rovira);
    return method;
}

namespace {

IdealPid wang_settings(const ReducedModel& model) {
    const double K = model.K, T = model.T1, L = model.L, Ti = T + 0.5 * L;
    return {.Kp = (0.7303 + 0.5307 * T / L) * Ti / (K * (T + L)), .Ti = Ti, .Td = 0.5 * L * T / Ti};
}

Expected<TunedController> tune_wang(const TuningProblem& problem, const FirstOrderOptions& options) {
    return tune_first_order(problem, options, {.name = "Wang-Juang-Chan", .min = 0.05, .max = 6}, wang_settings);
}

}  // namespace

TuningMethod wang_juang_chan_method() {
    TuningMethod method;
    method.id = "wang_juang_chan";
    method.title = "Wang-Juang-Chan";
    method.formula = "Kp = (0.7303 + 0.5307 T/L) (T + L/2)/(K (T + L)), Ti = T + L/2, Td = L T/(2 T + L)";
    method.source = "Wang, Juang and Chan, Chem. Eng. Communications 132 (1995) 15-34";
    method.needs = "fopdt with T > 0 and L > 0 (others are reduced)";
    method.validity = "L/T from 0.05 to 6; made for set-point steps";
    method.bind(first_order_options(), tune_wang);
    return method;
}

namespace {

using enum ControllerKind;
using enum FittedCriterion;

struct TwoRanges {
    ErrorIntegralRow up_to_1, above_1;
};

using Tables = std::map<ControllerKind, std::map<FittedCriterion, TwoRanges>>;

const Tables kServo{
    {PI,
     {{ise, {{0.980, -0.892, 0.690, -0.155}, {1.072, -0.560, 0.648, -0.114}}},
      {iste, {{0.712, -0.921, 0.968, -0.247}, {0.786, -0.559, 0.883, -0.158}}}}},
    {PID,
     {{ise, {{1.048, -0.897, 1.195, -0.368, 0.489, 0.888}, {1.154, -0.567, 1.047, -0.220, 0.490, 0.708}}},
      {iste, {{1.042, -0.897, 0.987, -0.238, 0.385, 0.906}, {1.142, -0.579, 0.919, -0.172, 0.384, 0.839}}}}},
};

const Tables kRegulation{
    {PI,
     {{ise, {{1.279, -0.945, 0.535, 0.586}, {1.346, -0.675, 0.552, 0.438}}},
      {iste, {{1.015, -0.957, 0.667, 0.552}, {1.065, -0.673, 0.687, 0.427}}}}},
    {PID,
     {{ise, {{1.473, -0.970, 1.115, 0.753, 0.550, 0.948}, {1.524, -0.735, 1.130, 0.641, 0.552, 0.851}}},
      {iste, {{1.468, -0.970, 0.942, 0.725, 0.443, 0.939}, {1.515, -0.730, 0.957, 0.598, 0.444, 0.847}}}}},
};

Expected<TunedController> tune_zhuang(const TuningProblem& problem, const ZhuangAthertonOptions& options) {
    const bool servo = options.mode == Mode::servo;
    const auto& rows = (servo ? kServo : kRegulation).at(options.controller).at(options.criterion);
    return tune_first_order(problem, options.model, {.name = "Zhuang-Atherton", .min = 0.1, .max = 2},
                            [&](const ReducedModel& model) {
                                return error_integral_settings(model.L <= model.T1 ? rows.up_to_1 : rows.above_1,
                                                               servo ? IntegralLaw::line : IntegralLaw::power, model);
                            });
}

}  // namespace

TuningMethod zhuang_atherton_method() {
    TuningMethod method;
    method.id = "zhuang_atherton";
    method.title = "Zhuang-Atherton";
    method.formula =
        "Kp = a1 (L/T)^b1/K, Td = a3 T (L/T)^b3; servo: Ti = T/(a2 + b2 L/T); regulation: Ti = T (L/T)^b2/a2. "
        "PID, ISTE, L/T up to 1, servo: 1.042, -0.897, 0.987, -0.238, 0.385, 0.906; regulation: 1.468, -0.970, 0.942, "
        "0.725, 0.443, 0.939. Tables for PI, ISE and L/T above 1 in docs/methods.md";
    method.source = "Zhuang and Atherton, IEE Proceedings D 140 (1993) 216-224";
    method.needs = "fopdt with T > 0 and L > 0 (others are reduced)";
    method.validity = "L/T from 0.1 to 2";
    OptionSet<ZhuangAthertonOptions> options;
    add_controller(options, {PI, PID});
    add_criterion(options, {iste, ise});
    add_mode(options);
    options.embed(&ZhuangAthertonOptions::model, first_order_options());
    method.variants = {{"PI", options.given_for({.controller = PI})},
                       {"PID", {}},
                       {"PID, regulation", options.given_for({.mode = Mode::regulation})}};
    method.bind(options, tune_zhuang);
    return method;
}

}  // namespace tunewright
