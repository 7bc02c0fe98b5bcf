// The loop with an input/output linearising controller that knows the plant's states: the loop that a PID is to
// emulate.
//
//   beta_r y^(r) + ... + beta_1 y' + y = v,   u = (v - sum_k beta_k L_f^k h) / (beta_r L_g L_f^(r-1) h)
//
// v is the set point, y and v deviations from the operating point, r the relative degree. First order: beta = {1,
// gamma} (Eq. 5-7); second order: {1, 2 xi tau_cl, tau_cl^2} (Eq. 8 with its middle term corrected). With a dead time
// the law acts on the state predicted over L (exactly, because the model is the plant): y follows L later. Source:
// Mhaskar, El-Farra & Christofides (2004).
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "engine/plant/nonlinear/lie_derivatives.h"
#include "engine/progress.h"
#include "engine/simulation/nonlinear/nonlinear_response.h"

namespace tunewright {

/// beta[0] = 1, one coefficient for each derivative up to the relative degree.
struct TargetResponse {
    std::vector<double> beta;
};
TargetResponse first_order_target(double gamma);
TargetResponse second_order_target(double tau_cl, double xi);
/// prod (s/(-p) + 1); poles in the open left half-plane, complex ones in pairs.
TargetResponse target_of_poles(const std::vector<std::complex<double>>& poles);

struct LinearisingOptions {
    double horizon = 0;  ///< > 0
    int samples = 401;   ///< samples from 0 to the horizon, >= 2
    double tolerance = 1e-10;
    std::vector<double> initial = {};  ///< absolute states at t = 0; empty: the steady state
};

struct LinearisingResponse {
    EvenSamples even;      ///< deviations; u after the limits
    bool limited = false;  ///< a limit of the input clipped u
    double t_end = 0;
    std::string ended;  ///< the reason for an early end; empty: it reached the horizon
};

/// `target` must suit the relative degree.
LinearisingResponse simulate_linearising(const NonlinearSystem& system, const TargetResponse& target,
                                         double setpoint_step, const LinearisingOptions& options,
                                         const RunControl& control);

}  // namespace tunewright
