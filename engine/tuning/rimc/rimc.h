// Revised internal model control (Liu and Gao): a PID with fast rejection of loads for plants with a slow time
// constant.
#pragma once

#include "engine/tuning/method/rule.h"
#include "engine/tuning/rimc/rimc_design.h"

namespace tunewright {

/// Approximation of the controller of Eq. 23 by a PID.
enum class RimcApproximation { maclaurin, linear_fractional };

/// At most one of lambda, Ms, disturbance_peak and dead_time_error; none: lambda is the model's T.
struct RimcOptions {
    std::optional<double> lambda = {};            ///< time constant of the closed loop
    std::optional<double> Ms = {};                ///< Ms of the loop with the model
    std::optional<double> disturbance_peak = {};  ///< peak of y per unit of load, with its sign
    std::optional<double> dead_time_error = {};   ///< error of the dead time that the loop tolerates by Eq. 29
    std::optional<double> Tf_over_Td = {};        ///< relative filter time of the derivative; empty: that of RimcFilter
    RimcApproximation approximation = RimcApproximation::maclaurin;
    bool curve = false;  ///< also return Fig. 2 of the source for this plant
    ReductionOptions reduction = {};
};

/// A filter zero in the closed loop T = (beta s + 1) e^(-theta s)/(lambda s + 1)^2 is placed so that 1 - T cancels the
/// model's slow pole; the controller's Maclaurin series gives the PID. One parameter: lambda, or in its place the
/// figure that it must give: Ms, the load response's peak, or a dead-time error by Eq. 29, each for the returned PID
/// with its filter on the model.
///
/// Source: Liu and Gao, "Relay-based autotuning of PID controller for improved load disturbance rejection", IFAC World
/// Congress (2008), Eqs. 16-29. In the source alpha is both a relay's shift and the filter zero (here beta); its tau_i
/// and tau_d are an inverse integral gain and a derivative gain, and the derivative filter (0.01 to 0.1) tau_d is used
/// as that fraction of tau_d/k_c: as printed its dimension is wrong, and the settings have too little margin.
TuningMethod rimc_method();

}  // namespace tunewright
