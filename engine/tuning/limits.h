// The default limits of a design, and the tolerance with which a limit is checked at each step: in the search, for the
// returned design, in a ranking, in a verdict. All of them are defined only here.
#pragma once

namespace tunewright::limits {

// ---- defaults

/// Largest peaks of |S| and |T|. Åström and Hägglund, Advanced PID Control (2006), section 4.6: reasonable Ms lie
/// between 1.2 and 2; Garpinger and Hägglund design for 1.4.
inline constexpr double kDefaultMs = 1.4, kDefaultMt = kDefaultMs;
/// The largest limit on Ms or Mt in a request: a loop with a larger peak is nearly unstable.
inline constexpr double kMaxMs = 4, kMaxMt = kMaxMs;
/// Time constant of the filter of a PID over Td (N = 10), if the plant bounds the gain.
inline constexpr double kDefaultTf_over_Td = 0.1;
/// Largest overshoot of a set-point step, percent.
inline constexpr double kDefaultMaxOvershootPercent = 5;
/// Largest Ms with which an entry ranks among those that keep their limits, whatever its own limit is: the upper end of
/// Åström and Hägglund's reasonable range.
inline constexpr double kDefaultMaxRankedMs = 2;

// ---- largest relative excess over a limit that counts as holding it, from the tightest to the widest

/// Step: the point of a search for one PID, after Newton's method has moved it back to its limits. Its result is within
/// rounding of them.
inline constexpr double kMaxRelativeExcessStepped = 1e-8;
/// Search: the end of a search, on the search's own frequencies. Far below the next tolerance, far above rounding.
inline constexpr double kMaxRelativeExcessSearched = 1e-6;
/// Find: the result of a search, on frequencies that the search did not use; and searches over Ti and Td, which
/// evaluate the loop between the points of their grid. Half of the next tolerance, so that a design still holds when it
/// is verified on other plants.
inline constexpr double kMaxRelativeExcessFound = 1e-5;
/// Verify: the returned design, on its own plants and on frequencies that the search did not use. The interpolated
/// peaks of the search have a smaller error.
inline constexpr double kMaxRelativeExcessVerified = 2e-5;
/// Judge: the same design on plants between its own, in a confidence region or a range. A plant that exceeds the limit
/// by more is added to those of the design.
inline constexpr double kMaxRelativeExcessJudged = 5e-5;
/// Rank: entries of a comparison under the limit that is common to all, whose peaks have been computed to about 1e-5.
inline constexpr double kMaxRelativeExcessRanked = 1e-4;
/// Show: a peak that prints as the limit with three digits counts as within it.
inline constexpr double kMaxRelativeExcessShown = 2e-3;
/// The same on the worst of several plants, which is found by a search.
inline constexpr double kMaxRelativeExcessShownOfWorst = 1e-2;

static_assert(kMaxRelativeExcessStepped < kMaxRelativeExcessSearched &&
                  kMaxRelativeExcessSearched < kMaxRelativeExcessFound &&
                  kMaxRelativeExcessFound < kMaxRelativeExcessVerified &&
                  kMaxRelativeExcessVerified < kMaxRelativeExcessJudged &&
                  kMaxRelativeExcessJudged < kMaxRelativeExcessRanked &&
                  kMaxRelativeExcessRanked < kMaxRelativeExcessShown &&
                  kMaxRelativeExcessShown < kMaxRelativeExcessShownOfWorst,
              "a later step must not reject what an earlier one accepts");

}  // namespace tunewright::limits
