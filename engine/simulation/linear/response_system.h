// The equations of a response: the delay system, the integral of y - r and the constant inputs.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/loop/delay_system.h"
#include "engine/numerics/cubic.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// The delay system with one more state, the integral of y - r, with the constant inputs inserted: x' = F x + G v + b,
/// row by row, for n states x and the delayed signal v.
struct ResponseSystem {
    DelaySystem s;
    int n = 0;
    std::vector<double> F, G, b;
    // Outputs y and u. Without the contribution of the states: y' = ... + YG v + Z v' + YH, u' = ... + MG v + N v' +
    // MH.
    std::vector<double> outputs;  // n columns: of y, y', u and u'
    double MG = 0, YG = 0, MH = 0, YH = 0;
    StepInputs in;
    bool delayed = false;
};

/// Without a dead time the loop is closed: v consists of the load alone.
ResponseSystem make_response_system(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in);
ResponseSystem make_response_system(const DelaySystem& loop, const StepInputs& in);

/// Contributions of the delayed signal v and of the constant inputs (times `constant`) to y, y', u and u'; that of the
/// states is separate.
inline std::array<double, 4> outputs_of(const ResponseSystem& system, Signal v, double constant) {
    const DelaySystem& s = system.s;
    return {s.Z * v.value + constant * (s.Y_r * system.in.r),
            system.YG * v.value + constant * system.YH + s.Z * v.slope, s.N * v.value + constant * (s.R * system.in.r),
            system.MG * v.value + constant * system.MH + s.N * v.slope};
}

/// A node at states x and delayed signal v (not used without dead time).
ResponseNode node_at(const ResponseSystem& system, double t, std::span<const double> x, Signal v);

}  // namespace tunewright
