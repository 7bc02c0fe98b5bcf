// The time between rows of a file without times, as the file states it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "api/csv/csv_record.h"
#include "api/csv/table.h"

namespace tunewright::api {

class ColumnFacts;

/// A sample time, or the one that follows from a stated sampling frequency.
struct FileSpacing {
    double rows_apart = 1;                   ///< above 0
    std::optional<double> seconds_per_unit;  ///< empty: the file names no unit
    bool frequency = false;                  ///< the file states a frequency; in Hz if it names no unit
    std::string text = {};                   ///< where the file states it; the subject of a sentence
};

/// The spacing in the unit of the answer. If the file names no unit, a sample time is in the unit given for the file's
/// times, else in that of the answer; a frequency is in Hz.
double spacing_of(const FileSpacing& spacing, const CsvOptions& options);

/// True if the file or the request names the unit.
bool unit_is_known(const FileSpacing& spacing, const CsvOptions& options);

/// The sentence that states how the times were made.
std::string spacing_note(const FileSpacing& spacing, const CsvOptions& options);

/// The spacing in comments and a preamble: "# fs = 100", "% Ts: 0.5 s", "Sample Period:","5 Sec", "Rate = 6 per
/// minute". The unit decides between time and frequency; a line with another word behind the number is not used.
std::optional<FileSpacing> spacing_above(std::string_view text, const CsvLayout& layout);

/// The spacing in a column named "Ts" or "fs" with one number, or always the same one, in a known unit or without one.
std::optional<FileSpacing> spacing_in_column(const ColumnFacts& facts, std::size_t column);

}  // namespace tunewright::api
