// Every threshold on which a finding or its level depends, with its reason. Two are elsewhere: tuning/limits.h decides
// when a limit holds, identification/model_grade.h grades the model of a record. docs/verdicts.md lists them for users.
#pragma once

#include "engine/evaluation/performance_figures.h"

namespace tunewright::verdict {

// Margins

/// First value: above this Ms little margin is left. Second: the loop has too little margin for a plant that changes.
/// Åström and Hägglund, Advanced PID Control (2006), section 4.6: reasonable Ms lie between 1.2 and 2.
inline constexpr double kLittleMarginMs = 1.7, kTooSharpMs = 2;
/// The response oscillates like a second-order loop with a damping of 0.26.
inline constexpr double kOscillatoryMt = 2;

/// Load IAE of a design over a record's region, as a multiple of that for the model alone. Above it the record's
/// uncertainty limits the speed, not the plant.
inline constexpr double kMaxRegionCost = 5;
/// A larger gain margin counts as unlimited.
inline constexpr double kUnlimitedGainMargin = 100;
/// Excess of the implemented loop over the ideal one that gives a warning: more than the uncertainty of an identified
/// gain.
inline constexpr double kWorsePercent_Ms = 5, kWorsePercent_IAE = 20;

// Set points

/// First value: overshoot that is reported. Second: the loop is not called good, because it overshoots by a quarter of
/// the step, like a second-order loop with a damping of 0.4.
inline constexpr double kOvershootPercent = 15, kLargeOvershootPercent = 25;
/// Percentage points of overshoot above the limit of a design. First value: reported, because it prints as another
/// figure. Second: not good, if the request set the limit; it is the band within which a response counts as settled.
inline constexpr double kOvershootAbove = 0.05, kOvershootFarAbove = 100 * kSettlingBand;

// Against today's settings

inline constexpr double kMaxNegligibleRatio = 1.15;  ///< ratios from 1/1.15 to 1.15 do not count as a difference
inline constexpr double kMaxIaeOverToday =
    0.95;  ///< share of today's load IAE: a smaller one makes a change worthwhile
inline constexpr double kMinRatioMovesMore = 1.5;  ///< multiple of today's movement of u
inline constexpr double kMinRatioMovesMuchMore = 3;

// Causes and cures

inline constexpr double kMaxCostRatioAsGood = 1.05;   ///< a design with at most this cost ratio is as good
inline constexpr double kExcessPercent = 10;          ///< over the optimum; more is reported
inline constexpr double kMinDeadTimeOverLags = 2;     ///< multiple of the lags: L/(L + T) above 2/3
inline constexpr double kMinFilterPhaseDegrees = 20;  ///< phase lag at the peak of |S|
inline constexpr double kMinNoisyMksOverKp = 20;      ///< Mks/|Kp|: beyond the usual derivative gains N of 2 to 20
inline constexpr double kUsualN = 10;               ///< Td/Tf of the filter that is tried for a derivative without one
inline constexpr double kMinNoiseOverRange = 0.02;  ///< standard deviation of u over the actuator's range

/// Relative: the u that holds the target may exceed a limit by this much through rounding.
inline constexpr double kRelativeLimitRounding = 1e-9;

// Choice of an entry

/// A controller whose load IAE is more than this multiple of that of another one is not chosen, if both keep the
/// limits, whatever its level: a step from Ms 2 down to 1.4 costs less.
inline constexpr double kManyFold = 3;

}  // namespace tunewright::verdict
