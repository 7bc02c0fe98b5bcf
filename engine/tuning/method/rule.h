// The common part of the closed-form rules: their options, the reduced model that they use, their answer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/reduction/reduction.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/method/option_set.h"

namespace tunewright {

enum class ControllerKind { P, PI, PID };

/// The purpose of a rule's settings: set-point steps or load steps.
enum class Mode { servo, regulation };

/// The reduction of a plant that does not have the rule's form.
struct ReductionOptions {
    ReductionMethod method = ReductionMethod::automatic;
    std::optional<double> horizon = {};  ///< for min_*: the end of their integral; empty: when settled
};

/// Filter of a PID: Tf if it is given, else Tf_over_Td Td; 0 for none.
struct FilterOptions {
    double Tf_over_Td = limits::kDefaultTf_over_Td;
    std::optional<double> Tf = {};
};

Words<ControllerKind> words_of(const std::vector<ControllerKind>& kinds);
OptionSet<ReductionOptions> reduction_options(const std::string& of_auto);
OptionSet<FilterOptions> filter_options(const FilterOptions& defaults);

inline constexpr const char* kControllerOption = "controller";

/// Option `controller` with the forms of the source.
template <class T>
void add_controller(OptionSet<T>& set, const std::vector<ControllerKind>& kinds) {
    set.choice(&T::controller, kControllerOption, "The type of controller.", words_of(kinds));
    set.main({kControllerOption});
}

/// Option `reduction {method, horizon}`; `automatic`: the meaning of "auto" for this rule.
template <class T>
void add_reduction(OptionSet<T>& set, const std::string& automatic) {
    set.object(&T::reduction, "reduction", "Reduction of a plant that does not have the rule's form.",
               reduction_options(automatic));
}

/// Option `filter {Tf_over_Td | Tf}`; `law`: the signal that is filtered.
template <class T>
void add_filter(OptionSet<T>& set, const std::string& law) {
    const FilterOptions* defaults = detail::content(set.defaults().filter);
    set.object(&T::filter, "filter", "Filter of a PID controller: " + law,
               filter_options(defaults ? *defaults : FilterOptions{}), 1);
}

/// Option `mode`.
template <class T>
void add_mode(OptionSet<T>& set) {
    set.choice(&T::mode, "mode", "Purpose of the settings: servo (set-point steps) or regulation (load steps).",
               Words<Mode>{{"servo", Mode::servo}, {"regulation", Mode::regulation}});
}

/// The filter of a PID with this Td.
Filter chosen_filter(const FilterOptions& options, FilterType type, double Td);

/// The model that the rule uses, by option `reduction`. Errors: those of reduce().
Expected<ReducedModel> rule_model(const TuningProblem& problem, const ReductionOptions& options,
                                  ReductionRequest request);

/// The same by the half rule, unless another one is requested: of second order for a PID, else of first.
Expected<ReducedModel> half_rule_model(const TuningProblem& problem, const ReductionOptions& options,
                                       ControllerKind controller);

/// L/(L + T1): 0 lag-dominated, 1 dead-time-dominated; 0 with an integrator.
double normalised_dead_time(const ReducedModel& model);

/// Error for a model whose zero would be a divisor: `sentence` has value and rule, `cure` an alternative.
Error degenerate(const std::string& where, const std::string& sentence, const std::string& cure);

Warning outside_validity(const std::string& detail);

/// Warning of a rule whose derivative action cancels the second lag, if there is none.
Warning no_second_lag();

/// The answer: controller, warnings (those of the reduction first), and the reduced model unless the plant has that
/// form. Errors: numerical_failure if a parameter is not a finite number or Kp is 0.
Expected<TunedController> rule_answer(const TuningProblem& problem, const ReducedModel& model, const IdealPid& pid,
                                      std::vector<Warning> warnings);

/// The answer of a rule that uses no reduced model. Errors: as above.
Expected<TunedController> rule_answer(const IdealPid& pid, std::vector<Warning> warnings);

}  // namespace tunewright
