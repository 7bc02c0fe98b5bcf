// The textbook construction of a first-order model with dead time from two points of a step response.
#pragma once

#include "engine/expected.h"
#include "engine/identification/fit/response.h"
#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// K e^(-Ls)/(T s + 1), dimensionless as the record (clean_record.h): `shape` holds L and ln T.
struct TwoPointModel {
    ModelShape shape;
    double K = 0;
};

/// T = 1.5 (t63 - t28), L = t63 - T, at least 0, with the times after the step at which y has reached 28.3 % and 63.2 %
/// of its response (Smith 1972); K is the change of y, from the mean before the step (or the given y0) to the mean of
/// the last tenth, divided by the change of u. For the two times y is averaged over a two-hundredth of the samples.
///
/// For y(t) = 1 - e^(-(t - L)/T), t > L, the two times are L + T/3 and L + T: a first-order plant with a dead time is
/// found exactly, up to the averaging and the spacing of the samples. A step of u by 2 at t = 0 after which y rises by
/// 3, through 0.849 at t = 5 and 1.896 at t = 9, gives T = 6, L = 3 and K = 1.5.
///
/// Errors: not_identifiable unless u moves once, 20 samples follow, and y has settled (the mean of the last tenth lies
/// within 5 % of the response of that of the tenth before).
Expected<TwoPointModel> two_point(const CleanRecord& record);

}  // namespace tunewright
