// The kind of test that a record shows (one step, several, a relay, anything else), and its state at the start.
#pragma once

#include <span>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// u as a sequence of levels, dimensionless: level[0] from time 0, level[j] from time[j] until time[j + 1] or the end.
/// Jitter below 2 % of u's range is not a move, and a slew within 1 % of the record, or over two samples, is one move.
struct InputLevels {
    std::vector<double> time, level;

    int moves() const { return static_cast<int>(level.size()) - 1; }
};

InputLevels input_levels(const CleanRecord& record);

/// When u moves, by its levels, in the record's unit of time: the first 20 times; more are another kind of test.
std::vector<double> move_times(const CleanRecord& record);

/// Switches between two levels whose distance is 10 times their variation. The level before the test and the one after
/// it, when the relay was off, may be different.
struct TwoLevels {
    double low = 0, high = 0;         ///< means
    std::vector<double> switch_time;  ///< ascending
    bool first_is_up = false;         ///< true: switch_time[0] goes to `high`
};

/// switch_time is empty if u does not alternate between two levels.
TwoLevels two_levels(const InputLevels& levels);

/// `step`: one move. `relay`: at least three switches between two levels that follow y, as a relay's do: y is nearly
/// the same at all switches of one direction, or the half periods are regular, and y still moves when u switches. A
/// pseudo-random sequence does not meet the first two conditions; a square wave with a settling y does not meet the
/// last. Else `several_steps` for fewer than 20 moves, `general` for more. Never `automatic`.
RecordKind found_kind(const CleanRecord& record);

/// "step", "several_steps", "relay", "general", "auto".
const char* name_of(RecordKind kind);

/// The state at the start of the record, from the rows before the first move of u.
enum class RecordStart {
    at_rest,  ///< y is at rest there, u0 is given, or u moves only once and there are no such rows
    unseen,   ///< too few rows to decide in a record in which u moves more than once, or a relay works from the first
              ///< row
    moving,   ///< y moves there, or a controller was switched on with the first row
};

/// Number of rows that distinguish a slope from its error.
inline constexpr int kRestRows = 5;

/// True if a signal with a range of about 1 over a record of length 1 moves in these first rows: its slope exceeds five
/// standard errors, and either the change in these rows is 0.03 and four times the scatter around the line, or the
/// slope also exceeds five errors that include the scatter's correlation and would change the signal by 0.05 until the
/// end of the record.
bool moves_at_first(std::span<const double> t, std::span<const double> values);

/// y moves if moves_at_first() is true for the rows before the first change of u. In a relay test that works from the
/// first row, y may be constant there for a dead time: it counts as at rest only if it stays within its noise until u
/// first switches. `noise` is y's standard deviation from sample to sample.
RecordStart start_of(const CleanRecord& record, bool relay, double noise);

}  // namespace tunewright
