// What the closed-form rules have in common: their options, the reduced model that they are written for, their answer.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/reduction/reduction.h"
#include "engine/tuning/method/method.h"

namespace tunewright {

/// Option `controller` with the forms that the source gives; "PID" is the default where it is among them.
OptionDescription controller_option(std::vector<std::string> choices);

/// Option `reduction {method, horizon}`; `automatic` says what "auto" does for this rule.
OptionDescription reduction_option(const std::string& automatic);

/// Option `filter {Tf_over_Td | Tf}` of a PID; `law` says what is filtered.
OptionDescription filter_option(const std::string& law);

/// Option `mode`, "servo" (set points) or "regulation" (loads).
OptionDescription mode_option(const std::string& by_default = "servo");

/// A row of "all": the options that differ from the defaults, all of them words.
MethodVariant row(const std::string& name, const std::vector<std::pair<std::string, std::string>>& words);

std::string chosen_controller(const MethodOptions& options);  ///< "P", "PI" or "PID"

/// The filter of a PID with this Td: Tf as given or Tf_over_Td Td (default 0.1); 0 gives `none`.
Filter chosen_filter(const MethodOptions& options, FilterType type, double Td);

/// The model that the rule works on, by option `reduction`. Errors: those of reduce().
Expected<ReducedModel> rule_model(const TuningProblem& problem, const MethodOptions& options, ReductionRequest request);

/// The same by the half rule, where no other is asked for: of second order for a PID, else of first.
Expected<ReducedModel> half_rule_model(const TuningProblem& problem, const MethodOptions& options);

/// L/(L + T1): 0 lag-dominated, 1 dead-time-dominated; 0 with an integrator.
double normalised_dead_time(const ReducedModel& model);

/// Error for a model that a rule would divide by: `sentence` names value and rule, `cure` another way.
Error degenerate(const std::string& where, const std::string& sentence, const std::string& cure);

Warning outside_validity(const std::string& detail);

/// Of a rule whose derivative action cancels the second lag, where there is none.
Warning no_second_lag();

/// The answer: controller, warnings of the reduction first, the reduced model unless the plant was given in its form.
/// Errors: numerical_failure if a parameter is not a finite number or Kp is 0.
Expected<TunedController> rule_answer(const TuningProblem& problem, const ReducedModel& model, const Pid& pid,
                                      std::vector<Warning> warnings);

/// The answer of a rule that works on no reduced model. Errors: as above.
Expected<TunedController> rule_answer(const Pid& pid, std::vector<Warning> warnings);

}  // namespace tunewright
