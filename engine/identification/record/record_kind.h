// What kind of test a record shows: one step, several, a relay, anything else.
#pragma once

#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// u as the levels that it rests at, dimensionless: level[0] from time 0, level[j] from time[j] until time[j + 1] or
/// the end. Jitter below 2 % of u's range is no move, and a slew within 1 % of the record, or over two samples,
/// is one move.
struct InputLevels {
    std::vector<double> time, level;

    int moves() const { return static_cast<int>(level.size()) - 1; }
};

InputLevels input_levels(const CleanRecord& record);

/// Switches between two levels that lie 10 times as far apart as each varies. The level before the test and the one
/// after it, where the relay was turned off, may be others.
struct TwoLevels {
    double low = 0, high = 0;         ///< means
    std::vector<double> switch_time;  ///< ascending
    bool first_is_up = false;         ///< whether switch_time[0] goes to `high`
};

/// Empty switch_time where u does not alternate between two levels.
TwoLevels two_levels(const InputLevels& levels);

/// `step`: one move. `relay`: at least three switches between two levels that follow y, as a relay's do: y is nearly
/// the same at all switches of one direction, or the half periods are regular, and y still moves when u switches. A
/// pseudo-random sequence fails the first two, a square wave that lets y settle the last. Else `several_steps` for
/// fewer than 20 moves, `general` for more. Never `automatic`.
RecordKind found_kind(const CleanRecord& record);

/// "step", "several_steps", "relay", "general", "auto".
const char* name_of(RecordKind kind);

}  // namespace tunewright
