#include "engine/tuning/reaction_curve/error_integral_table.h"

#include <cmath>

namespace tunewright {

Pid error_integral_settings(const ErrorIntegralRow& row, IntegralLaw law, const ReducedModel& model) {
    const double q = model.L / model.T1;
    Pid pid{.Kp = row.a1 * std::pow(q, row.b1) / model.K};
    if (row.a2 != 0)
        pid.Ti = model.T1 * (law == IntegralLaw::power ? std::pow(q, row.b2) / row.a2 : 1 / (row.a2 + row.b2 * q));
    if (row.a3 != 0) pid.Td = model.T1 * row.a3 * std::pow(q, row.b3);
    return pid;
}

const char* to_string(FittedCriterion criterion) {
    switch (criterion) {
        case FittedCriterion::ise: return "ise";
        case FittedCriterion::iae: return "iae";
        case FittedCriterion::itae: return "itae";
        case FittedCriterion::itse: return "itse";
        case FittedCriterion::iste: return "iste";
        case FittedCriterion::istse: return "istse";
    }
    return "";
}

}  // namespace tunewright
