// Rows of a loop: their order in time, and values of tags that each have times of their own.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "api/historian/mode_track.h"
#include "api/historian/tagged_loop.h"

namespace tunewright::api {

/// Values of one tag at its own times; NaN: bad or missing.
struct TagValues {
    std::vector<double> t, value;
};

/// Modes of one loop at their own times, as indices in TaggedLoop::mode_words.
struct TagModes {
    std::vector<double> t;
    std::vector<std::uint8_t> mode;
};

/// Sorts by time if necessary. Of several values at one time the first is kept.
void put_in_order(TagValues& tag);
void put_in_order(TagModes& tag);

/// The rows of a loop from tags in the order of time, in three steps.
///
/// 1. The rows are the times of y.
/// 2. If the times of y are irregular, y was stored only when it changed: where it is silent for more than 2.5 of its
///    usual spacings, the times of u become rows too, and y holds its value there. If they are regular, such a silence
///    is a gap.
/// 3. u, r and the mode hold their last value.
void join_tags(const TagValues& y, const TagValues& u, const TagValues& r, const TagModes& mode, TaggedLoop& loop);

/// Sorts the rows by time if necessary and leaves out rows at the time of the row before; a note says how many.
void put_rows_in_order(TaggedLoop& loop);

/// Fills r from the row before.
void hold(std::vector<double>& r);

/// Gives the loop the words of its modes. Codes without a meaning are not read: the column is then removed, and a note
/// names `tag`.
void take_mode_words(const ModeTrack& track, const std::string& tag, TaggedLoop& loop);

/// Sets the fault and frees the columns.
void set_fault(TaggedLoop& loop, std::string sentence);

/// Sets the fault of a loop that has no number in y or u, whose tags have these names.
void refuse_empty(TaggedLoop& loop, const std::string& y_name, const std::string& u_name);

/// Times that start again, as counted by a logger without dates: they continue at the usual spacing. Returns the
/// number of restarts. Times from the newest to the oldest, and single times that are out of order, are left alone.
int continue_restarted(std::vector<double>& t);

}  // namespace tunewright::api
