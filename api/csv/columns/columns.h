// Which columns of a CSV file hold time, controller output and measurement.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading.h"
#include "api/csv/record.h"
#include "api/csv/table.h"

namespace tunewright::api {

/// A sample time or sampling frequency as a file says it.
struct FileSpacing {
    bool frequency = false;
    double value = 1;
    std::string unit = {};  ///< "" for s or Hz
    std::string text = {};  ///< where it stands
};

/// In `time_unit`.
double spacing_of(const FileSpacing& spacing, const std::string& time_unit);

/// What comments and a preamble say of it: "# fs = 100", "% Ts: 0.5 s", "Sample Period:","5 Sec".
std::optional<FileSpacing> spacing_above(std::string_view text, const CsvLayout& layout);

struct FoundColumns {
    std::array<std::optional<std::size_t>, kRoleCount> at;
    std::optional<std::size_t> clock;    ///< a second column of times of day, where at[kTimeRole] holds dates alone
    std::optional<std::size_t> spacing;  ///< instead of times: a column that holds the samples' spacing
    std::optional<FileSpacing> head_spacing;  ///< where neither: what stands above the data
    std::vector<std::size_t> d;               ///< measured disturbances, as chosen
    std::vector<std::string> notes;
};

/// The columns as chosen; then by their headings; then, where headings do not say, by what they hold: time rises, u
/// stays on its levels while y moves. What remains open is a fault that lists the headings. A set point is reported
/// where it is found, and is never u or y.
FoundColumns find_columns(std::string_view text, const CsvLayout& layout, const std::vector<ColumnProfile>& profiles,
                          const CsvOptions& options, std::vector<CsvFault>& faults);

}  // namespace tunewright::api
