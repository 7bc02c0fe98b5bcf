#include "engine/tuning/reaction_curve/tavakoli.h"

#include "engine/tuning/method/first_order_rule.h"

namespace tunewright {
namespace {

IdealPid min_ise(const ReducedModel& model) {
    const double L = model.L, q = L / model.T1;
    return {.Kp = (0.3 * q + 0.75) / (q + 0.05) / model.K, .Ti = L * 2.4 / (q + 0.4), .Td = L / (90 * q)};
}

IdealPid min_iae(const ReducedModel& model) {
    const double L = model.L, q = L / model.T1;
    return {.Kp = 1 / (q + 0.2) / model.K, .Ti = L * (0.3 * q + 1.2) / (q + 0.08), .Td = L / (90 * q)};
}

IdealPid min_itae(const ReducedModel& model) {
    const double L = model.L, q = L / model.T1;
    return {.Kp = 0.8 / (q + 0.1) / model.K, .Ti = L * (0.3 + 1 / q), .Td = L * 0.06 / (q + 0.04)};
}

template <IdealPid (*settings)(const ReducedModel&)>
Expected<TunedController> tune_tavakoli(const TuningProblem& problem, const FirstOrderOptions& options) {
    return tune_first_order(problem, options, {.name = "Tavakoli", .min = 0.1, .max = 2}, settings);
}

TuningMethod described(const std::string& id, const std::string& criterion, const std::string& formula) {
    TuningMethod method;
    method.id = "tavakoli_" + id;
    method.title = "Tavakoli " + criterion;
    method.formula = "q = L/T; " + formula;
    method.source =
        "Tavakoli and Tavakoli, Proc. 4th Int. Conf. Control and Automation (2003) 942-946; taken from Jin and Son "
        "(2019), Table 1";
    method.needs = "fopdt with T > 0 and L > 0 (others are reduced)";
    method.validity = "L/T from 0.1 to 2; made for set-point steps";
    return method;
}

}  // namespace

TuningMethod tavakoli_ise_method() {
    TuningMethod method =
        described("ise", "ISE", "Kp = (0.3 q + 0.75)/(K (q + 0.05)), Ti = 2.4 L/(q + 0.4), Td = L/(90 q)");
    method.bind(first_order_options(), tune_tavakoli<min_ise>);
    return method;
}

TuningMethod tavakoli_iae_method() {
    TuningMethod method =
        described("iae", "IAE", "Kp = 1/(K (q + 0.2)), Ti = L (0.3 q + 1.2)/(q + 0.08), Td = L/(90 q)");
    method.bind(first_order_options(), tune_tavakoli<min_iae>);
    return method;
}

TuningMethod tavakoli_itae_method() {
    TuningMethod method =
        described("itae", "ITAE", "Kp = 0.8/(K (q + 0.1)), Ti = L (0.3 + 1/q), Td = 0.06 L/(q + 0.04)");
    method.bind(first_order_options(), tune_tavakoli<min_itae>);
    return method;
}

}  // namespace tunewright
