#include "engine/tuning/reaction_curve/zhuang_atherton.h"

#include <map>
namespace tunewright {
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

Expected<TunedController> tune(const TuningProblem& problem, const ZhuangAthertonOptions& options) {
    const bool servo = options.mode == Mode::servo;
    const auto& rows = (servo ? kServo : kRegulation).at(options.controller).at(options.criterion);
    return tune_first_order(problem, options.model, {.name = "Zhuang-Atherton", .least = 0.1, .most = 2},
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
        "Kp = a1 (L/T)^b1/K, Td = a3 T (L/T)^b3; servo: Ti = T/(a2 + b2 L/T), regulation: Ti = T (L/T)^b2/a2. "
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
    method.serve(options, tune);
    return method;
}

}  // namespace tunewright
