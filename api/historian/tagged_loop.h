// A loop as read from a file of many loops, in columns, and the order of its rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/historian/values/mode_track.h"

namespace tunewright::api {

/// The rows of one loop, in the order of time, with at least one of y and u in each. The columns have equal lengths,
/// or are empty if the file does not have them.
struct TaggedLoop {
    std::string tag = {};
    std::vector<double> t;           ///< in the unit that was asked for; from the first row of the file if it has dates
    std::vector<double> y, u;        ///< NaN: missing, or of bad quality
    std::vector<double> r;           ///< set point, held from row to row; NaN before the first one
    std::vector<std::uint8_t> mode;  ///< index in mode_words, held from row to row
    std::vector<std::string> mode_words;  ///< as in the file; the first is "", unknown
    std::optional<double> epoch;          ///< seconds since 1970 at t = 0; empty: the file has no dates
    bool utc = false;                     ///< the file states the zone of its times
    int bad = 0;                          ///< values of y and u that the file marks as bad
    bool only_tag = false;                ///< a part of a loop: `tag` is "FIC101.PV", with values in y or in mode
    std::vector<std::string> notes;       ///< findings, one sentence each
    std::optional<std::string> fault;     ///< the reason why the loop cannot be read; the columns are then empty
};

/// The rows in the order of time, without those at the time of an earlier one; empty if all are so already.
std::vector<std::size_t> time_order(const std::vector<double>& t);

template <class Column>
void take_rows(const std::vector<std::size_t>& rows, Column& column) {
    if (column.empty()) return;
    Column out;
    out.reserve(rows.size());
    for (const std::size_t i : rows) out.push_back(column[i]);
    column = std::move(out);
}

/// Sorts the rows by time if necessary and leaves out rows at the time of the row before; a note says how many.
void put_rows_in_order(TaggedLoop& loop);

/// Fills r from the row before.
void hold(std::vector<double>& r);

/// Gives the loop the words of its modes. Codes without a meaning are not read: the column is then removed, and a note
/// names `tag`.
void take_mode_words(const ModeTrack& track, const std::string& tag, TaggedLoop& loop);

/// The notes, with the number of values that the file marks as bad; of very many only the first.
std::vector<std::string> reading_notes(const TaggedLoop& loop);

/// Sets the fault and frees the columns.
void set_fault(TaggedLoop& loop, std::string sentence);

/// Sets the fault of a loop that has no number in y or u, whose tags have these names.
void refuse_empty(TaggedLoop& loop, const std::string& y_name, const std::string& u_name);

/// Times that start again, as counted by a logger without dates: they continue at the usual spacing. Returns the
/// number of restarts. Times from the newest to the oldest, and single times that are out of order, are left alone.
int continue_restarted(std::vector<double>& t);

}  // namespace tunewright::api
