// The proof that a robust design is the optimum, as the method's report.
#pragma once

#include "engine/certificate/certificate.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/robust/design.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright::robust {

/// Adds the certificate of the design at `x` with the load IAE `upper` to the result, or a warning with the reason why
/// there is none: another objective or limit, several plants, a filter or a plant that certificates do not know.
void add_certificate(const DesignProblem& problem, const RobustOptions& options, double upper,
                     const RunControl& control, TunedController& result);

}  // namespace tunewright::robust
