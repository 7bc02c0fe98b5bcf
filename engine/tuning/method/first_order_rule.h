// What the rules on K e^(-Ls)/(T s + 1) share: the model, what they refuse, their range in L/T, the filter, the answer.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "engine/tuning/method/rule.h"

namespace tunewright {

struct FirstOrderRule {
    std::string name;  ///< as sentences call it
    double min = 0;    ///< range of L/T for which the source gives the rule
    double max = std::numeric_limits<double>::infinity();
    bool has_integrating_form = false;                      ///< also for K e^(-Ls)/s
    TangentTime tangent_time = TangentTime::at_63_percent;  ///< T of the tangent that plants of other forms get
};

/// Options that every such rule has.
struct FirstOrderOptions {
    ReductionOptions reduction = {};
    FilterOptions filter = {};
};

OptionSet<FirstOrderOptions> first_order_options();

/// What such a rule refuses: L = 0, T = 0, two integrators and, without an integrating form, one.
std::optional<Error> unfit(const ReducedModel& model, const FirstOrderRule& rule);

/// `settings` on the model of the plant (by option `reduction`, tangent first), with a derivative filter by option
/// `filter`. Warns "outside-validity" with L/T beyond the rule's range.
/// Errors: those of reduce(); unsupported for L = 0, T = 0, a negative Ti and, without an integrating form, for
/// integrating plants.
Expected<TunedController> tune_first_order(const TuningProblem& problem, const FirstOrderOptions& options,
                                           const FirstOrderRule& rule,
                                           const std::function<IdealPid(const ReducedModel&)>& settings);

}  // namespace tunewright
