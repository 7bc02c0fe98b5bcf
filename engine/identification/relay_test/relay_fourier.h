// Models from the oscillation of a relay test by closed formulas: Liu and Gao, "Relay-based autotuning of PID
// controller for improved load disturbance rejection", section 2.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "engine/expected.h"
#include "engine/identification/fit/response.h"
#include "engine/identification/relay_test/recorded_cycle.h"

namespace tunewright {

/// A model by the formulas; dimensionless. `structure`: fopdt, unstable, ipdt or ipdt_lag.
struct RelayModel {
    ModelShape shape;
    double K = 0;                 ///< gain; slope for integrating structures
    double fit_rms = 0;           ///< root of Eq. 15's mean square over the steady periods, from their harmonics
    bool by_static_gain = false;  ///< Eq. 14 was used instead of Eq. 13
};

/// sqrt(2 sum |Y_k - G(jk omega) U_k|^2) for a model of this shape and gain.
double harmonic_misfit(const RecordedCycle& cycle, const ModelShape& shape, double K);

/// k_p from Eq. 14, tau from Eq. 11, theta from Eq. 12. Empty if |k_p| <= A_u or its sign contradicts the phase.
std::optional<RelayModel> biased_fopdt(const RecordedCycle& cycle);

/// All solutions of Eqs. 11 to 13 with theta >= 0 for this structure, least misfit first. Eqs. 11 and 12 give k_p and
/// theta for every tau; Newton's method within brackets solves Eq. 13 for tau. `shifted`: G(sigma + j omega). fopdt: K
/// e^(-Ls)/(Ts + 1); unstable: K e^(-Ls)/(1 - Ts); ipdt_lag: K e^(-Ls)/(s (Ts + 1)).
std::vector<RelayModel> unbiased_models(const RecordedCycle& cycle, std::complex<double> shifted, double sigma,
                                        Structure structure);

/// K = A_u omega, L = (-phi_u - pi/2)/omega. Empty if the phase allows no dead time.
std::optional<RelayModel> integrating_model(const RecordedCycle& cycle);

}  // namespace tunewright
