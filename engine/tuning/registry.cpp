#include <algorithm>

#include "engine/tuning/amigo.h"
#include "engine/tuning/arrieta.h"
#include "engine/tuning/imc.h"
#include "engine/tuning/lambda.h"
#include "engine/tuning/method.h"
#include "engine/tuning/npid_rule.h"
#include "engine/tuning/rimc.h"
#include "engine/tuning/robust.h"
#include "engine/tuning/simc.h"
#include "engine/tuning/ziegler_nichols_step.h"

namespace tunewright {

const std::vector<TuningMethod>& method_registry() {
    static const std::vector<TuningMethod> methods = {
        robust_method(),   rimc_method(),     arrieta_ms_method(), arrieta_degradation_method(),
        npid_ise_method(), npid_iae_method(), npid_itae_method(),  amigo_method(),
        simc_method(),     lambda_method(),   imc_method(),        ziegler_nichols_step_method(),
    };
    return methods;
}

const TuningMethod* find_method(const std::string& id) {
    const auto& methods = method_registry();
    const auto at = std::ranges::find(methods, id, &TuningMethod::id);
    return at == methods.end() ? nullptr : &*at;
}

}  // namespace tunewright
