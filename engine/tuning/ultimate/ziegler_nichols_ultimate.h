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

/// For any linear plant that oscillates with some proportional gain:
///
///     P     Kp = 0.5 Ku
///     PI    Kp = 0.45 Ku   Ti = Pu/1.2
///     PID   Kp = 0.6 Ku    Ti = Pu/2     Td = Pu/8      classic
///           Kp = 0.7 Ku    Ti = 0.4 Pu   Td = 0.15 Pu   pessen: Pessen's integral rule
///           Kp = Ku/3      Ti = Pu/2     Td = Pu/3      some_overshoot: less gain, more damping
///           Kp = 0.2 Ku    Ti = Pu/2     Td = Pu/3      no_overshoot: even less gain
///
/// The classic rule aims at quarter-amplitude damping: Ms is typically above 2.
///
/// Sources: Ziegler & Nichols, Trans. ASME 64 (1942) 759-768; Pessen, J. Dyn. Syst. Meas. Control 116 (1994) 553-557;
/// the two overshoot variants are those of Perry & Chilton, Chemical Engineers' Handbook (1973), as the textbooks give
/// them. Range of K Ku: Hang, Åström & Ho, IEE Proc. D 138 (1991) 111-118.
TuningMethod ziegler_nichols_ultimate_method();
inline constexpr const char* kZieglerNicholsUltimate = "ziegler_nichols_ultimate";  ///< its id

/// The same without a request.
Expected<TunedController> tune_ziegler_nichols_ultimate(const TuningProblem& problem,
                                                        const ZieglerNicholsUltimateOptions& options);

}  // namespace tunewright
