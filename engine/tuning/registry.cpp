#include <algorithm>

#include "engine/tuning/amigo.h"
#include "engine/tuning/amigo_ultimate.h"
#include "engine/tuning/arrieta.h"
#include "engine/tuning/chien_hrones_reswick.h"
#include "engine/tuning/cohen_coon.h"
#include "engine/tuning/emulation.h"
#include "engine/tuning/gain_phase_margin.h"
#include "engine/tuning/haalman.h"
#include "engine/tuning/imc.h"
#include "engine/tuning/improved_simc.h"
#include "engine/tuning/kappa_tau.h"
#include "engine/tuning/lambda.h"
#include "engine/tuning/lopez.h"
#include "engine/tuning/method.h"
#include "engine/tuning/npid_rule.h"
#include "engine/tuning/rimc.h"
#include "engine/tuning/robust.h"
#include "engine/tuning/rovira.h"
#include "engine/tuning/simc.h"
#include "engine/tuning/tavakoli.h"
#include "engine/tuning/tyreus_luyben.h"
#include "engine/tuning/visioli_integrating.h"
#include "engine/tuning/wang_juang_chan.h"
#include "engine/tuning/zhuang_atherton.h"
#include "engine/tuning/ziegler_nichols_step.h"
#include "engine/tuning/ziegler_nichols_ultimate.h"

namespace tunewright {

const std::vector<TuningMethod>& method_registry() {
    static const std::vector<TuningMethod> methods = {
        robust_method(),
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
        improved_simc_method(),
        amigo_ultimate_method(),
        kappa_tau_method(),
        haalman_method(),
        gain_phase_margin_method(),
        visioli_integrating_method(),
    };
    return methods;
}

const TuningMethod* find_method(const std::string& id) {
    const auto& methods = method_registry();
    const auto at = std::ranges::find(methods, id, &TuningMethod::id);
    return at == methods.end() ? nullptr : &*at;
}

}  // namespace tunewright
