// Several runs in one file: times that start again.
#pragma once

#include <optional>

#include "api/csv/csv_record.h"

namespace tunewright::api {

/// A file whose times start again more often is not in the order of time and is refused.
inline constexpr int kMaxFileRuns = 1000;

/// Keeps the rows of one run in `record`:
///
/// 1. The times start again at a row that lies before the previous one by at least half of the run's duration, if the
///    next rows continue from there. A row far ahead of its neighbours, or a single earlier one, is a false time and
///    starts no run; a record from the newest row to the oldest is one run.
/// 2. Rows that count down (9, 8, ..., 0) in front of rows that count up at their spacing are the time before a test:
///    they get the times -9 to 0 and stay with it. Otherwise they are a separate run.
/// 3. The `chosen` run is taken, counted from 1; else the longest in which u moves and y then moves too, by a twentieth
///    of its range in the whole file; else the longest.
///
///     t,u,y
///     0,0,20      run 1: u does not move
///     1,0,20
///     ...
///     0,0,20      run 2, of the logger started again: taken
///     1,5,20
///
/// Fills record.runs (with the times as the file counts them) and record.run if there are several, and reports it: in
/// record.unread if none was chosen, else in the notes. Returns a fault if there is no run `chosen`, or if there are
/// too many.
std::optional<CsvFault> take_run(CsvRecord& record, std::optional<int> chosen);

}  // namespace tunewright::api
