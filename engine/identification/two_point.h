// The textbook construction: a first-order model from two points of a step response.
#pragma once

#include "engine/expected.h"
#include "engine/identification/fit/response.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// Dimensionless, as the record.
struct TwoPointModel {
    ModelShape shape;
    double K = 0;
};

/// T = 1.5 (t63 - t28), L = t63 - T with the times at which y has moved by 28.3 % and 63.2 % (Smith 1972), K from the
/// mean of the last tenth. y is averaged over a two-hundredth of the samples. Errors: not_identifiable unless u moves
/// once and y has settled (last tenth within 5 % of the tenth before).
Expected<TwoPointModel> two_point(const CleanRecord& record);

}  // namespace tunewright
