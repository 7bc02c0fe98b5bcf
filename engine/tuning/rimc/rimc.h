// Revised internal model control (Liu and Gao): a PID for quick recovery from loads on plants with a slow time
// constant.
#pragma once

#include "engine/tuning/method/rule.h"
#include "engine/tuning/rimc/rimc_design.h"

namespace tunewright {

/// How the controller of Eq. 23 becomes a PID.
enum class RimcApproximation { maclaurin, linear_fractional };

/// At most one of lambda, Ms, disturbance_peak and dead_time_error; none: lambda is the model's T.
struct RimcOptions {
    std::optional<double> lambda = {};            ///< time constant of the closed loop
    std::optional<double> Ms = {};                ///< of the loop with the model
    std::optional<double> disturbance_peak = {};  ///< of y per unit of load, signed
    std::optional<double> dead_time_error = {};   ///< that the loop shall stand by Eq. 29
    std::optional<double> Tf_over_Td = {};        ///< of the derivative's filter; empty: RimcFilter's
    RimcApproximation approximation = RimcApproximation::maclaurin;
    bool curve = false;  ///< also return Fig. 2 for this plant
    ReductionOptions reduction = {};
};

/// A filter zero in the closed loop T = (beta s + 1) e^(-theta s)/(lambda s + 1)^2 is placed so that 1 - T cancels the
/// model's slow pole; the controller's Maclaurin series gives the PID. One parameter, lambda, or what it shall achieve
/// in its place: Ms, the load response's peak, or a dead-time error by Eq. 29, each of the returned PID with its filter
/// on the model.
///
/// Source: Liu and Gao, "Relay-based autotuning of PID controller for improved load disturbance rejection", IFAC World
/// Congress (2008), Eqs. 16-29. In the source alpha is both a relay's shift and the filter zero (here beta); its tau_i
/// and tau_d are an inverse integral gain and a derivative gain, and the derivative filter (0.01 to 0.1) tau_d is read
/// as that fraction of tau_d/k_c: as printed its dimension is wrong, and the tunings lose their margin.
TuningMethod rimc_method();

}  // namespace tunewright
