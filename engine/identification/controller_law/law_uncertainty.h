// How far the coefficients of a law may be off.
#pragma once

#include <array>
#include <vector>

#include "engine/identification/controller_law/law_search.h"

namespace tunewright {

/// By columns; kLawFilter is ln Tf. 0 where the law has no such column.
using LawCovariance = std::array<std::array<double, kLawColumns>, kLawColumns>;

/// The sandwich of Newey and West (1987) over the whitened rows with n^(1/3) lags, the filter's constant included; no
/// variance is below that of ordinary least squares. Infinite where the filter's constant cannot be told from the rest.
LawCovariance law_covariance(const LawSamples& samples, const std::vector<char>& used, const FoundLaw& law);

/// Standard deviation of the white part of y's noise, from third differences; of fewer than 5 values: 0.
double white_noise(const std::vector<double>& y);

/// The fit without what errors of y, white and of this variance, add to the moments of P and D: bias-compensated least
/// squares (Stoica and Soderstrom 1982). Not solved where such errors would explain all of y's moves.
LawFit without_errors_of_y(const LawSamples& samples, const LawMoments& m, const FoundLaw& law, double variance);

}  // namespace tunewright
