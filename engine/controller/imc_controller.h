// The revised IMC controller before its reduction to a PID: it contains the model's dead time.
#pragma once

#include <cmath>
#include <complex>

namespace tunewright {

/// With theta > 0 no PID equals this controller: figures and responses of the full one (loop/imc_loop.h,
/// simulation/imc) show the loss through the reduction to a PID.
///
/// C = Q/(1 - G Q) on the model G = kp e^(-theta s)/(tau s + 1), with
///   Q = (beta s + 1)(tau s + 1)/(kp (lambda s + 1)^2),
/// so that the nominal T is (beta s + 1) e^(-theta s)/(lambda s + 1)^2. Liu and Gao (2008), Eqs. 19-23; beta, the
/// filter's zero, is their alpha of Eq. 21 (they use that letter twice).
struct ImcController {
    double kp = 0;      ///< the model's static gain, y per u; != 0
    double tau = 0;     ///< > 0; all times are in the plant's unit
    double theta = 0;   ///< >= 0
    double lambda = 0;  ///< > 0: the nominal closed loop's double time constant
    double beta = 0;    ///< either sign; Eq. 21 chooses it so that 1 - G Q vanishes at s = -1/tau

    /// G(s) for any s that is not its pole -1/tau.
    std::complex<double> model(std::complex<double> s) const { return kp * std::exp(-theta * s) / (tau * s + 1.0); }
    /// Transfer function from r - (y - y_model) to u, y_model = G u; proper: Q(infinity) = beta tau/(kp lambda^2).
    std::complex<double> Q(std::complex<double> s) const {
        return (beta * s + 1.0) * (tau * s + 1.0) / (kp * (lambda * s + 1.0) * (lambda * s + 1.0));
    }
};

}  // namespace tunewright
