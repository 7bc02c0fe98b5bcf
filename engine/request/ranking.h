// The order of a comparison: what holds what was asked for stands before what does not, and then what wastes least.
#pragma once

#include <string>
#include <vector>

#include "engine/request/entry.h"

namespace tunewright {

/// What the order depends on beside the entries.
struct RankingTerms {
    double rank_Ms = 0;     ///< largest Ms of every entry that holds
    bool over_time = true;  ///< false: the plant is known by points alone, and nothing is known to settle
};

RankingTerms ranking_terms(const EvaluateOptions& options, bool over_time);

/// Fills every evaluated entry's `standing` and returns the indices of these entries, best first:
/// - stable before unstable, settling before not, within the limits on Ms before beyond;
/// - then by the excess of the load IAE over the least at the same Ms, or at the nearest where there is none;
/// - then, and where no optimum is known, by the load IAE.
/// Of a nonlinear plant settling and load IAE are those of its own responses, which the linearisation's may flatter.
/// Today's settings are held to the loosest limit that was asked of a design as well, where every design was asked for
/// one.
std::vector<int> ranked(std::vector<TuningEntry>& entries, const RankingTerms& terms);

/// That in a sentence for the answer. It names the excess where at least one of the entries was compared with an
/// optimum, else the load IAE.
std::string ranking_by(const std::vector<TuningEntry>& entries, const RankingTerms& terms);

}  // namespace tunewright
