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
    std::optional<ColumnChoice> t, u, y;
};

struct CsvOptions {
    ColumnChoices columns;
    std::string time_unit = "s";  ///< of the answer
    bool time_unit_given =
        false;  ///< false: the unit in the time heading is believed and converted from only if it is not s
    std::optional<double> dt;  ///< spacing for files without a time column, in time_unit
    std::size_t most_samples = 200'000;
};

struct CsvRecord {
    std::vector<double> t, u, y;
    int dropped = 0;                 ///< lines left out: a cell of t, u or y is blank, NaN, ...
    std::vector<std::string> notes;  ///< what was found by itself, one sentence each
};

/// `where` is "csv" or "columns/t", ...
struct CsvFault {
    std::string where;
    std::string message;
};

/// Columns that are not chosen are found where the headings are plain (t, time, ...; u, op, mv, ...; y, pv, ...), by
/// name without case or unit ("PV [degC]"). Time stamps become seconds since the first and then `time_unit`. At most
/// ten faults.
std::variant<CsvRecord, std::vector<CsvFault>> read_csv_record(std::string_view text, const CsvOptions& options);

}  // namespace tunewright::api
