// The limits of a check, each in one place with its reason.
#pragma once

#include <cstddef>

namespace tunewright::check {

// The record.
inline constexpr std::size_t kFewestRows = 200;  ///< below it no oscillation, law or valve can be told
inline constexpr double kMostMissing = 0.5;      ///< of the rows: beyond it a diagnosis would judge the gaps
inline constexpr double kLeastPart = 0.3;        ///< of the record's time: its longest part without a gap
inline constexpr double kStraight = 0.3;         ///< share of rows on a straight line through their neighbours
inline constexpr double kStairs = 0.6;           ///< share of rows that repeat the one before, with many levels
inline constexpr int kFewLevels = 20;            ///< levels of a coarse measurement (chemai, section 14)

// Service.
inline constexpr std::size_t kStillRows = 30;  ///< an output that rests for fewer rows is only rounded
inline constexpr double kStillShare = 0.03;    ///< of the record, likewise
inline constexpr double kAtLimit = 0.002;      ///< of the output's range: at its limit

// Oscillation.
inline constexpr double kRegular = 1;        ///< regularity of an oscillation (Thornhill, Huang and Zhang 2003)
inline constexpr double kMostRegular = 1e4;  ///< a larger one is only rounding
inline constexpr double kLeastShare = 0.05;  ///< of the error's variance: a smaller oscillation is not looked for

// Causes that the record shows by itself.
inline constexpr double kHeldShare = 0.3;        ///< of the time with an output that nobody moves: in manual
inline constexpr double kFrozenShare = 0.5;      ///< of the time with a measurement that stands still
inline constexpr double kFrozenRun = 0.1;        ///< of the time in one stand-still, far longer than the others
inline constexpr double kFewestCyclesTold = 6;   ///< in the record: fewer are moves, not an oscillation
inline constexpr double kSaturatedShare = 0.05;  ///< of the time at a limit
inline constexpr double kCoarseStep = 0.5;       ///< of the measurement's deviation: a step that hides everything finer

// Oscillations that are no valve's.
inline constexpr double kLine = 0.7, kSureLine = 0.93;  ///< share of one exact frequency: from outside
inline constexpr double kDrifts =
    14;  ///< power beside the sine: below it the sine is from outside, above it the loop's own
inline constexpr double kResonant = 8, kSurelyResonant = 20,
                        kLongResonant = 5;  ///< regularity of a loop near its stability limit
inline constexpr double kPersistent = 0.33, kSurelyPersistent = 0.45;  ///< its correlation after three periods
inline constexpr double kCyclesOfResonance = 20, kSureCycles = 40, kLongCycles = 60;
inline constexpr double kLongPersistent = 0.24;  ///< over that many cycles
inline constexpr double kOscillates = 5;         ///< regularity that asks for an explanation

// Valves: ln of the residual's square, and ln of odds.
inline constexpr double kSureValveGain = 0.12, kSureValveStrength = 60;

// Loops that do not oscillate.
inline constexpr double kHeldSteps = 3;         ///< of the output's grid, that its proportional part would have moved
inline constexpr int kFewestCrossings = 6;      ///< of the set point by block means beyond the noise
inline constexpr double kFreeOfMoves = 0.65;    ///< share of rows that a set-point move does not reach
inline constexpr double kMoveReach = 10;        ///< integral times behind a set-point move
inline constexpr double kClearResponse = 0.15;  ///< noise of the mean response to set-point moves, of the move
inline constexpr double kSluggishRise =
    3.5;                                  ///< rise over dead time: 1 to 2 with SIMC, 5 at eight times its time constant
inline constexpr double kKnownLaw = 0.9;  ///< of the output's moves explained by a PI law
inline constexpr double kSlow = 0.75, kPerhapsSlow = 0.5, kSurelySlow = 0.8;  ///< likelihood of a sluggish loop

}  // namespace tunewright::check
