// The coefficients of a sign function's Jackson mean (Jackson 1912; Weisse et al., Reviews of Modern Physics 78 (2006)
// 275, section II.C.3). The kernel 1 + 2 sum g_m cos(m x) = |sum a_v e^(jvx)|^2/sum a_v^2, a_v = sin(pi (v + 1)/(K +
// 1)), is positive with mean 1, so that the mean of a sign stays within [-1, 1].
#pragma once

#include <vector>

#include "engine/certificate/certificate.h"
#include "engine/certificate/interval.h"

namespace tunewright::certificate {

/// g_0 ... g_(K-1).
std::vector<Interval> jackson_factors(int K);

/// a_0 ... a_(K-1) of the mean: phi = sum a_m cos(m x).
std::vector<Interval> mean_coefficients(const SignFunction& sign, const std::vector<Interval>& factors);

}  // namespace tunewright::certificate
