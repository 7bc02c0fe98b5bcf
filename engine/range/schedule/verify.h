// A schedule looked at over the whole range, between its rows and the places of any search.
#pragma once

#include <vector>

#include "engine/expected.h"
#include "engine/range/schedule/own_optima.h"
#include "engine/range/schedule/schedule.h"

namespace tunewright::range {

/// Of ln of a limit: what a verified schedule may exceed it by.
constexpr double kAllowedLogExcess = 2e-5;

struct Verified {
    double excess = -1;         ///< ln of the largest of Ms, Mt, Mks over its limit
    double log_price = -1;      ///< the largest ln of IAE over that of the own optimum
    std::vector<double> worst;  ///< places where the price allowed is exceeded, and limits by more than a little (5e-4)
};

/// At 49 places evenly over the range, at nine between each two rows, and at the tops of the parabolas through those
/// that come near a limit or near `allowed`, the ln of the price. Errors: the model's.
Expected<Verified> verify(const Places& places, const OwnOptima& own, const Schedule& schedule, double allowed);

}  // namespace tunewright::range
