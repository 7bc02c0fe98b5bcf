// A recorded test as people export it: CSV text in, columns of numbers out.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tunewright::api {

/// A heading, or the column's number from 1.
using ColumnChoice = std::variant<std::string, int>;

struct ColumnChoices {
    std::optional<ColumnChoice> t, u, y, r = {};
};

struct CsvOptions {
    ColumnChoices columns;
    std::string time_unit = "s";  ///< of the answer
    bool time_unit_given =
        false;  ///< false: the unit in the time heading is believed and converted from only if it is not s
    std::optional<double> dt;              ///< spacing for files without a time column, in time_unit
    std::string unit_u = {}, unit_y = {};  ///< as the user names them; "" if not
    std::size_t most_samples = 2'000'000;
};

struct CsvRecord {
    std::vector<double> t, u, y;     ///< u and y are NaN where a cell is blank, "Bad", ...; never both
    std::vector<double> r;           ///< set point, a number in each sample; empty: the file has none
    std::vector<int> lines;          ///< of each sample in the file, from 1
    int dropped = 0;                 ///< lines left out: without a time, or with neither u nor y
    std::vector<std::string> notes;  ///< what was found by itself, one sentence each
};

/// `where` is "csv" or "columns/t", ...
struct CsvFault {
    std::string where;
    std::string message;
};

/// `bytes` in any usual encoding (text.h), with any usual separator and sign of decimals (table.h, cell.h), times
/// as numbers or stamps (time_stamp.h), columns as chosen, or found (columns.h). Times become `time_unit`: stamps
/// since the first one; numbers from the unit of their heading. Times that count milliseconds or less since 1970, and
/// spreadsheets' days under a heading such as "Date", are known by their size. A clock set back by an hour, and one
/// without a date that passes midnight, go on. At most ten faults, each with its line.
std::variant<CsvRecord, std::vector<CsvFault>> read_csv_record(std::string_view bytes, const CsvOptions& options);

}  // namespace tunewright::api
