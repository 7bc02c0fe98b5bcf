// A recorded test in an exported file: reads CSV text into columns of numbers.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/csv/column_choice.h"
#include "engine/identification/record/record.h"

namespace tunewright::api {

struct CsvOptions {
    ColumnChoices columns;
    std::string time_unit = "s";      ///< of the answer
    bool time_unit_given = false;     ///< false: the unit in the time heading is used and converted only if it is not s
    std::string file_time_unit = {};  ///< unit of the file's times, which overrides the file; "" to use the file's own
    std::optional<double> dt;         ///< spacing for files without a time column, in time_unit
    std::optional<std::array<double, 2>> u_step = {};  ///< for a file without u: the values before and from its first
                                                       ///< row
    std::optional<int> run = {};                       ///< the chosen run of a file with several (runs.h), from 1
    std::string unit_u = {}, unit_y = {};              ///< as the user names them; "" if not given
    std::size_t max_samples = 2'000'000;
};

/// A line that is not a row.
struct CsvSkip {
    int line = 0;
    std::string reason;
};

/// One of several runs in a file.
struct CsvRun {
    int first_line = 0, last_line = 0;
    int rows = 0;
    double from = 0, to = 0;  ///< times
    bool tests = false;       ///< u moves and y responds
};

struct CsvRecord {
    std::vector<double> t, u, y;         ///< u and y are NaN where a cell is blank, "Bad", ...; never both
    std::vector<double> r;               ///< set point, a number in each sample; empty if the file has none
    std::vector<bool> automatic;         ///< as in Record; empty if the file has no mode
    std::vector<FurtherInput> d;         ///< measured disturbances; NaN where a cell holds no number
    std::vector<int> lines;              ///< line of each sample in the file, from 1
    int dropped = 0;                     ///< lines left out: unreadable, without a time, or with neither u nor y
    std::string unread;                  ///< a sentence about the lines that could not be read; "" if there are none
    std::string unread_column;           ///< DetectedColumns::unread
    std::string unknown_mode;            ///< a sentence about modes that are not known; "" if there are none
    std::vector<CsvSkip> skipped;        ///< the first kMaxSkips of them, and the lines above the rows
    std::vector<CsvRun> runs;            ///< one for each restart of the times; empty if there is one run
    int run = 1;                         ///< the one that is read, from 1
    bool u_stepped = false;              ///< u was made from CsvOptions::u_step
    std::optional<double> u_full_scale;  ///< 100 if heading or unit state percent
    bool time_unit_known = true;         ///< stated by the file or by the options; otherwise the times are assumed to
                                         ///< be in time_unit
    std::vector<std::string> notes;      ///< automatic decisions, one sentence each
};

inline constexpr std::size_t kMaxSkips = 100;

/// `where` is "csv", "run", "u_step", or "columns/t", ...
struct CsvFault {
    std::string where;
    std::string message;
};

/// Reads `bytes` in any usual encoding (text.h), with any usual separator and decimal sign (table.h, cell.h), times as
/// numbers or stamps (time_stamp.h), columns as chosen, or found (columns.h). Times are converted to `time_unit`:
/// stamps from the first one; numbers from the unit of their heading. Times in milliseconds or smaller units since
/// 1970, and spreadsheets' days (under a heading such as "Date", or in steps of whole seconds or minutes), are
/// recognised by their size. A clock that is set back by an hour, or that passes midnight without a date, runs on.
/// Lines that cannot be read (a total at the end, half a line of a serial port) are left out (`unread`) if they are at
/// most one in fifty; otherwise there are at most ten faults, each with its line.
std::variant<CsvRecord, std::vector<CsvFault>> read_csv_record(std::string_view bytes, const CsvOptions& options);

/// Reads an opened file (shape/shape.h).
class CsvSource;
std::variant<CsvRecord, std::vector<CsvFault>> read_csv_record(const CsvSource& source, const CsvOptions& options);

}  // namespace tunewright::api
