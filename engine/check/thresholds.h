// The limits of a check, each in one place with its reason.
#pragma once

#include <cstddef>

namespace tunewright::check {

// The record.
inline constexpr std::size_t kFewestRows = 200;   ///< below it no oscillation, law or valve can be told
inline constexpr double kMostMissing = 0.5;       ///< of the rows: beyond it a diagnosis would judge the gaps
inline constexpr double kLeastPart = 0.3;         ///< of the record's time: its longest part without a gap
inline constexpr double kStraight = 0.3;          ///< share of rows on a straight line through their neighbours
inline constexpr double kStairs = 0.6;            ///< share of rows that repeat the one before, with many levels
inline constexpr int kFewLevels = 20;             ///< levels of a coarse measurement (chemai, section 14)

// Service.
inline constexpr std::size_t kStillRows = 30;     ///< an output that rests for fewer rows is only rounded
inline constexpr double kStillShare = 0.03;       ///< of the record, likewise
inline constexpr double kAtLimit = 0.002;         ///< of the output's range: at its limit

// Oscillation.
inline constexpr double kRegular = 1;       ///< regularity of an oscillation (Thornhill, Huang and Zhang 2003)
inline constexpr double kMostRegular = 1e4; ///< a larger one is only rounding
inline constexpr double kLeastShare = 0.05; ///< of the error's variance: a smaller oscillation is not looked for

}  // namespace tunewright::check
