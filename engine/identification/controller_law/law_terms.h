// The terms of a law that the record shows, and its form among those that fit equally well.
#pragma once

#include <optional>
#include <vector>

#include "engine/identification/controller_law/law_search.h"

namespace tunewright {

/// Standard deviations within which a term is 0; one of twenty that is 0 stays.
inline constexpr double kZeroDeviations = 2;

/// Difference of the criterion within which two laws are equally good: residuals that are not white make large records
/// too sure.
double as_good(const FoundLaw& law);

/// Makes the first of `laws` one whose derivative and filter differ from 0 by more than two standard deviations: the
/// others are left out one by one, each with the best law that is left. A gain or an integral is never left out.
void leave_zero_terms_out(const LawSamples& samples, const std::vector<char>& used, FoundLaws& laws);

/// Makes the first of `laws` one with this filter, if there is one with the same terms that is as good.
void prefer_filter(LawFilter filter, FoundLaws& laws);

}  // namespace tunewright
