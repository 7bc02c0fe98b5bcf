// Ziegler and Nichols' rules from the ultimate gain and period, and their later variants.
#pragma once

#include "engine/tuning/method/ultimate_rule.h"

namespace tunewright {

enum class ZieglerNicholsVariant { classic, pessen, some_overshoot, no_overshoot };

struct ZieglerNicholsUltimateOptions {
    ControllerKind controller = ControllerKind::PID;
    ZieglerNicholsVariant variant = ZieglerNicholsVariant::classic;  ///< of PID
    UltimateOptions point = {};
    FilterOptions filter = {};
};

/// P: Kp = 0.5 Ku; PI: Kp = 0.45 Ku, Ti = Pu/1.2; PID: Kp = 0.6 Ku, Ti = Pu/2, Td = Pu/8; pessen: 0.7 Ku, 0.4 Pu, 0.15
/// Pu; some_overshoot: Ku/3, Pu/2, Pu/3; no_overshoot: 0.2 Ku, Pu/2, Pu/3. `variant` of the PID: classic; pessen,
/// Pessen's integral rule; some_overshoot and no_overshoot, which give up gain for damping. Any linear plant that a
/// proportional gain brings to oscillation. The classic rule aims at quarter-amplitude damping: Ms is typically
/// above 2. Sources: Ziegler & Nichols, Trans. ASME 64 (1942) 759-768; Pessen, J. Dyn. Syst. Meas. Control 116 (1994)
/// 553-557; the two overshoot variants are those of Perry & Chilton, Chemical Engineers' Handbook (1973), as the
/// textbooks give them. Range of K Ku: Hang, Astrom & Ho, IEE Proc. D 138 (1991) 111-118.
TuningMethod ziegler_nichols_ultimate_method();
inline constexpr const char* kZieglerNicholsUltimate = "ziegler_nichols_ultimate";  ///< its id

/// The same without a request.
Expected<TunedController> tune_ziegler_nichols_ultimate(const TuningProblem& problem,
                                                        const ZieglerNicholsUltimateOptions& options);

}  // namespace tunewright
