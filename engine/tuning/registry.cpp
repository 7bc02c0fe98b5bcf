#include "engine/tuning/registry.h"

#include <algorithm>

#include "engine/number_text.h"
#include "engine/tuning/arrieta/arrieta.h"
#include "engine/tuning/emulation/emulation.h"
#include "engine/tuning/formula/formula_rule.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/method/setpoint.h"
#include "engine/tuning/model_based/gain_phase_margin.h"
#include "engine/tuning/model_based/haalman.h"
#include "engine/tuning/model_based/imc.h"
#include "engine/tuning/model_based/improved_simc.h"
#include "engine/tuning/model_based/lambda.h"
#include "engine/tuning/model_based/simc.h"
#include "engine/tuning/model_based/visioli_integrating.h"
#include "engine/tuning/npid/npid_rule.h"
#include "engine/tuning/reaction_curve/amigo.h"
#include "engine/tuning/reaction_curve/chien_hrones_reswick.h"
#include "engine/tuning/reaction_curve/cohen_coon.h"
#include "engine/tuning/reaction_curve/error_integral_rules.h"
#include "engine/tuning/reaction_curve/kappa_tau.h"
#include "engine/tuning/reaction_curve/t_sum.h"
#include "engine/tuning/reaction_curve/tavakoli.h"
#include "engine/tuning/reaction_curve/ziegler_nichols_step.h"
#include "engine/tuning/rimc/rimc.h"
#include "engine/tuning/robust/frontier.h"
#include "engine/tuning/ultimate/amigo_ultimate.h"
#include "engine/tuning/ultimate/tyreus_luyben.h"
#include "engine/tuning/ultimate/ziegler_nichols_ultimate.h"

namespace tunewright {
namespace {

std::vector<TuningMethod> all_methods() {
    return {
        robust_method(),
        frontier_method(),
        rimc_method(),
        arrieta_ms_method(),
        arrieta_degradation_method(),
        npid_ise_method(),
        npid_iae_method(),
        npid_itae_method(),
        emulation_method(),
        amigo_method(),
        simc_method(),
        lambda_method(),
        imc_method(),
        ziegler_nichols_step_method(),
        ziegler_nichols_ultimate_method(),
        tyreus_luyben_method(),
        cohen_coon_method(),
        chien_hrones_reswick_method(),
        tavakoli_ise_method(),
        tavakoli_iae_method(),
        tavakoli_itae_method(),
        lopez_method(),
        rovira_method(),
        zhuang_atherton_method(),
        wang_juang_chan_method(),
        t_sum_method(),
        improved_simc_method(),
        amigo_ultimate_method(),
        kappa_tau_method(),
        haalman_method(),
        gain_phase_margin_method(),
        visioli_integrating_method(),
        formula_method(),
    };
}

}  // namespace

const std::vector<TuningMethod>& method_registry() {
    static const auto methods = [] {
        std::vector<TuningMethod> all = all_methods();
        for (TuningMethod& method : all)
            if (method.weighs_setpoint)
                method.options.push_back(setpoint_option(
                    method.overshoot ? "overshoot at most " + text(limits::kDefaultMaxOvershootPercent) +
                                           " %; with an objective that includes the set point, b = 1"
                                     : "the weight in the source",
                    bool(method.overshoot)));
        return all;
    }();
    return methods;
}

const std::string& default_method() { return method_registry().front().id; }

const TuningMethod* find_method(const std::string& id) {
    const auto& methods = method_registry();
    const auto at = std::ranges::find(methods, id, &TuningMethod::id);
    return at == methods.end() ? nullptr : &*at;
}

}  // namespace tunewright
