#include "engine/tuning/reaction_curve/wang_juang_chan.h"

#include "engine/tuning/method/first_order_rule.h"

namespace tunewright {
namespace {

Pid settings(const ReducedModel& model) {
    const double K = model.K, T = model.T1, L = model.L, Ti = T + 0.5 * L;
    return {.Kp = (0.7303 + 0.5307 * T / L) * Ti / (K * (T + L)), .Ti = Ti, .Td = 0.5 * L * T / Ti};
}

Expected<TunedController> tune(const TuningProblem& problem, const FirstOrderOptions& options) {
    return tune_first_order(problem, options, {.name = "Wang-Juang-Chan", .least = 0.05, .most = 6}, settings);
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
    method.serve(first_order_options(), tune);
    return method;
}

}  // namespace tunewright
