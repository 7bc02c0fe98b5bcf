// The common part of the rules on K e^(-Ls)/(T s + 1): the model, the errors, the range of L/T, the filter, the answer.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct FirstOrderRule {
    std::string name;  ///< name of the rule in sentences
    double min = 0;    ///< smallest L/T for which the source gives the rule; the largest follows
    double max = std::numeric_limits<double>::infinity();
    bool has_integrating_form = false;                      ///< also for K e^(-Ls)/s
    TangentTime tangent_time = TangentTime::at_63_percent;  ///< T of the tangent for plants of other forms
};

/// The options of every such rule.
struct FirstOrderOptions {
    ReductionOptions reduction = {};
    FilterOptions filter = {};
};

OptionSet<FirstOrderOptions> first_order_options();

/// Errors of such a rule: L = 0, T = 0, two integrators and, without an integrating form, one.
std::optional<Error> unfit(const ReducedModel& model, const FirstOrderRule& rule);

/// Applies `settings` to the model of the plant (option `reduction`, tangent by default), with a derivative filter
/// (option `filter`). Warns "outside-validity" if L/T is outside the rule's range. Errors: those of reduce();
/// unsupported for L = 0, T = 0, a negative Ti and, without an integrating form, for integrating plants.
Expected<TunedController> tune_first_order(const TuningProblem& problem, const FirstOrderOptions& options,
                                           const FirstOrderRule& rule,
                                           const std::function<IdealPid(const ReducedModel&)>& settings);

}  // namespace tunewright
