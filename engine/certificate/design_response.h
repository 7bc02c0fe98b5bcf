// What the search takes from responses: the loop's scales, and the sign of y after a load step. None of it is part of
// the proof.
#pragma once

#include <optional>

#include "engine/certificate/certificate.h"
#include "engine/expected.h"

namespace tunewright::certificate {

/// The controller of a point of the box.
ParallelPid controller_at(const CertificateProblem& problem, const std::array<double, 3>& unknowns);

/// About 1.5 times the frequency of the largest |S| of the design.
double frequency_scale(const CertificateProblem& problem, double time_scale);

struct LoadResponse {
    double IAE = 0;
    double time_of_most = 0;  ///< by which 99.9 % of the IAE has come
    SignFunction sign;        ///< for a given half period
};

/// Empty: the loop is not stable, or its response does not settle. `half_period`: of the sign function, pi/w0; 0: no
/// sign.
std::optional<LoadResponse> load_response(const CertificateProblem& problem, const LinearPlant& plant,
                                          const std::array<double, 3>& unknowns, double half_period);

}  // namespace tunewright::certificate
