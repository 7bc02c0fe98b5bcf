// Every threshold on which a finding or its level depends, with its reason; when a limit holds stands in
// tuning/limits.h, the grade of a record's model is concluded in identification/model_grade.h. docs/verdicts.md lists
// them for users.
#pragma once

#include "engine/evaluation/performance_figures.h"

namespace tunewright::verdict {

// Margins

/// Above this Ms little margin is left, and above the second the loop is too sharp for a plant that changes. Åström
/// and Hägglund, Advanced PID Control (2006), section 4.6: reasonable Ms lie between 1.2 and 2.
inline constexpr double kLittleMarginMs = 1.7, kTooSharpMs = 2;
/// The response rings as a second-order loop with a damping of 0.26 does.
inline constexpr double kOscillatoryMt = 2;

/// Load IAE of a design over a record's region, in times that of the one for the model alone, above which the record's
/// doubt sets the speed and not the plant.
inline constexpr double kMaxRegionCost = 5;
/// A gain margin beyond it is as good as none.
inline constexpr double kUnlimitedGainMargin = 100;
/// Excess of the loop as built over the ideal one that is a warning: beyond what an identified gain is known to.
inline constexpr double kWorsePercent_Ms = 5, kWorsePercent_IAE = 20;

// Set points

/// Overshoot worth a word, and from where on the loop is not called good: a quarter of the step, as a second-order loop
/// with a damping of 0.4 has it.
inline constexpr double kOvershootPercent = 15, kLargeOvershootPercent = 25;
/// Percentage points of overshoot above the limit of a design: worth a word from what prints as another figure. Where
/// the request set the limit, not good from the band on within which a response counts as settled.
inline constexpr double kOvershootAbove = 0.05, kOvershootFarAbove = 100 * kSettlingBand;

// Against today's settings

inline constexpr double kMaxNegligibleRatio = 1.15;  ///< ratios between its inverse and itself are no difference
inline constexpr double kMaxIaeOverToday = 0.95;     ///< of today's load IAE: less is worth a change
inline constexpr double kMinRatioMovesMore = 1.5;    ///< times the movement of u today
inline constexpr double kMinRatioMovesMuchMore = 3;

// Causes and cures

inline constexpr double kMaxCostRatioAsGood = 1.05;   ///< another design may cost so much more and be as good
inline constexpr double kExcessPercent = 10;          ///< over the optimum, worth a word
inline constexpr double kMinDeadTimeOverLags = 2;     ///< times the lags: L/(L + T) above 2/3
inline constexpr double kMinFilterPhaseDegrees = 20;  ///< of phase at the peak of |S|
inline constexpr double kMinNoisyMksOverKp = 20;      ///< Mks over |Kp|: beyond the usual derivative gains N of 2 to 20
inline constexpr double kUsualN = 10;               ///< Td/Tf of the filter that a derivative without one is tried with
inline constexpr double kMinNoiseOverRange = 0.02;  ///< standard deviation of u over the actuator's range

// Which to take

/// A controller that costs more than so many times the load IAE of another that keeps the limits too is not taken,
/// however good its level: margins from Ms 2 down to 1.4 cost less than that.
inline constexpr double kManyFold = 3;

}  // namespace tunewright::verdict
