// The time between rows of a file without times, as the file says it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "api/csv/csv_record.h"
#include "api/csv/table.h"

namespace tunewright::api {

class ColumnFacts;

/// A sample time, also of a file that says a sampling frequency.
struct FileSpacing {
    double rows_apart = 1;                   ///< above 0
    std::optional<double> seconds_per_unit;  ///< empty: the file names no unit
    bool frequency = false;                  ///< the file says how often; without a unit in Hz
    std::string text = {};                   ///< where it stands, the subject of a sentence
};

/// In the unit of the answer. Where the file names no unit, a sample time is in the unit that is given for the file's
/// times, else in that of the answer; a frequency is in Hz.
double spacing_of(const FileSpacing& spacing, const CsvOptions& options);

/// The file names its unit, or the request does.
bool unit_is_known(const FileSpacing& spacing, const CsvOptions& options);

/// The sentence that says what the times are made from.
std::string spacing_note(const FileSpacing& spacing, const CsvOptions& options);

/// The spacing in comments and a preamble: "# fs = 100", "% Ts: 0.5 s", "Sample Period:","5 Sec", "Rate = 6 per
/// minute". The unit decides between time and frequency; a line with another word behind the number says nothing that
/// is known.
std::optional<FileSpacing> spacing_above(std::string_view text, const CsvLayout& layout);

/// A column named "Ts" or "fs" with one number, or always the same one, in a unit that is known or in none.
std::optional<FileSpacing> spacing_in_column(const ColumnFacts& facts, std::size_t column);

}  // namespace tunewright::api
