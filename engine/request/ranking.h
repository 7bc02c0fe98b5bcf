// The order of a comparison: entries that keep their limits come first, then those with the least excess load IAE.
#pragma once

#include <string>
#include <vector>

#include "engine/request/entry.h"

namespace tunewright {

/// The inputs of the order other than the entries.
struct RankingTerms {
    double rank_Ms = 0;     ///< the limit on Ms of every entry
    bool over_time = true;  ///< false: the plant is known by points alone, so settling is unknown
};

RankingTerms ranking_terms(const EvaluateOptions& options, bool over_time);

/// Fills every evaluated entry's `standing` and returns the indices of these entries, best first:
/// - stable before unstable, settling before not, within the limits on Ms before beyond;
/// - then by the excess of the load IAE over the least at the same Ms, or at the nearest Ms that has an optimum;
/// - then, or if no optimum is known, by the load IAE.
/// For a nonlinear plant, settling and load IAE are those of its
///   own responses, because the linearisation's may look better. If every design has a limit on Ms, today's settings
///   must keep the loosest of them.
std::vector<int> ranked(std::vector<TuningEntry>& entries, const RankingTerms& terms);

/// The ranking's criterion as a sentence for the answer. It names the excess if at least one entry was compared with an
/// optimum, else the load IAE.
std::string ranking_by(const std::vector<TuningEntry>& entries, const RankingTerms& terms);

}  // namespace tunewright
