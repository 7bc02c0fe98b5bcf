#include "engine/tuning/model_based/visioli_integrating.h"

#include <map>

namespace tunewright {
namespace {

struct Row {
    double K_L_Kp, Ti_over_L, Td_over_L;
};

using enum FittedCriterion;

const std::map<FittedCriterion, Row> kTable{
    {ise, {1.37, 1.49, 0.59}}, {itse, {1.36, 1.66, 0.53}}, {istse, {1.34, 1.83, 0.49}}};

Expected<TunedController> tune_visioli_integrating(const TuningProblem& problem,
                                                   const VisioliIntegratingOptions& options) {
    const auto model = rule_model(problem, options.reduction, {.preferred = ReductionMethod::tangent});
    if (!model) return model.error();
    if (model->integrators != 1)
        return degenerate("plant", "Visioli's rule is for integrating plants, but this one has no integrator.",
                          "Use lopez, or another rule for stable plants.");
    if (model->L <= 0)
        return degenerate("plant/L", "Visioli's rule divides by the dead time, but that of the model is 0.",
                          "Give the true dead time of the loop, or use lambda with lambda, simc with tau_c, or robust "
                          "with a fixed filter Tf.");
    const Row& row = kTable.at(options.criterion);
    const double L = model->L;
    IdealPid answer{.Kp = row.K_L_Kp / (model->K * L), .Ti = row.Ti_over_L * L, .Td = row.Td_over_L * L};
    answer.filter = chosen_filter(options.filter, FilterType::derivative, answer.Td);
    return rule_answer(problem, *model, answer, {});
}

}  // namespace

TuningMethod visioli_integrating_method() {
    TuningMethod method;
    method.id = "visioli_integrating";
    method.title = "Visioli, integrating plants";
    method.formula = "K L Kp, Ti/L, Td/L: ISTSE 1.34, 1.83, 0.49; ITSE 1.36, 1.66, 0.53; ISE 1.37, 1.49, 0.59";
    method.source = "Visioli, IEE Proc. Control Theory and Applications 148 (2001) 180-184";
    method.needs = "ipdt with L > 0 (other integrating plants are reduced)";
    method.validity = "integrating plants; made for load steps, without a limit on Ms";
    OptionSet<VisioliIntegratingOptions> options;
    add_criterion(options, {istse, itse, ise});
    add_reduction(options, "the asymptote of the ramp; half_rule if that leads the step.");
    add_filter(options, "of the derivative part, Td s/(1 + s Tf); the source has none.");
    method.bind(options, tune_visioli_integrating);
    return method;
}

}  // namespace tunewright
