// Which moves of u a law explains: residuals, and the rows that they add or leave out.
#pragma once

#include <vector>

#include "engine/identification/controller_law/law_search.h"

namespace tunewright {

struct LawResiduals {
    LawColumns white;
    std::vector<double> e;       ///< of each whitened row
    std::vector<int> increment;  ///< the sample at which it ends; -1: the free start of a stretch
};
LawResiduals law_residuals(const LawSamples& samples, const std::vector<char>& used, const FoundLaw& law);

/// Leaves increments out that are off the law: bumps of a switch to automatic, a set point that moved between rows.
/// `least`: the standard deviation that rounding leaves. Returns how many.
int leave_odd_out(const LawSamples& samples, std::vector<char>& used, const FoundLaw& law, double least);

/// Takes stretches in which u stands still, also the first one at an end of its range, back in where the law moves u by
/// no more than `hidden` and rounding. The others are manual or limited.
void take_still_in(LawSamples& samples, const FoundLaw& law, double hidden);

}  // namespace tunewright
