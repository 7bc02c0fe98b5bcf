// Several runs in one file: times that begin again.
#pragma once

#include <optional>

#include "api/csv/csv_record.h"

namespace tunewright::api {

/// A file whose times begin again more often is not in the order of its times, and is refused.
inline constexpr int kMaxFileRuns = 1000;

/// Keeps the rows of one run in `record`:
///
/// 1. The times begin again where a row is at least half of what the run has covered before the rows above it, and the
///    next rows go on from there. A row far ahead of its neighbours, or a single one of the past, is a false time and
///    begins nothing; a record from the newest row to the oldest is one run.
/// 2. Rows that count down (9, 8, ..., 0) in front of rows that count up at their spacing are the time before a test:
///    they get the times -9 to 0 and stay with it. Otherwise they are a run of their own.
/// 3. Taken is the `chosen` run, counted from 1; else the longest in which u moves and y then moves too, by a twentieth
///    of what it does in the whole file; else the longest.
///
///     t,u,y
///     0,0,20      run 1: u does not move
///     1,0,20
///     ...
///     0,0,20      run 2, of the logger started again: taken
///     1,5,20
///
/// Fills record.runs (with the times as the file counts them) and record.run where there are several, and says so: in
/// record.unread where nobody chose, else in the notes. Returns a fault where there is no run `chosen`, or where there
/// are too many.
std::optional<CsvFault> take_run(CsvRecord& record, std::optional<int> chosen);

}  // namespace tunewright::api
