// Which columns of a CSV file hold time, controller output and measurement.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/file_spacing.h"
#include "api/csv/columns/heading.h"
#include "api/csv/csv_record.h"
#include "api/csv/table.h"

namespace tunewright::api {

struct FoundColumns {
    std::array<std::optional<std::size_t>, kRoleCount> at;
    std::optional<std::size_t> clock;  ///< a second column of times of day, where at[kTimeRole] holds dates alone
    std::optional<std::size_t> spacing_column;  ///< instead of times: it holds the samples' spacing
    std::optional<FileSpacing> spacing;         ///< instead of times: of that column, or as stands above the data
    std::vector<std::size_t> d;                 ///< measured disturbances, as chosen
    std::vector<std::string> notes;
    std::string unread;  ///< a sentence about columns that may be u where CsvOptions::u_step is given; "" for none
};

/// The columns as chosen; then by their headings; then, where headings do not say, by what they hold: time rises, u
/// stays on its levels while y moves. What remains open is a fault that lists the headings. A set point is reported
/// where it is found, and is never u or y.
FoundColumns find_columns(std::string_view text, const CsvLayout& layout, const std::vector<ColumnProfile>& profiles,
                          const CsvOptions& options, std::vector<CsvFault>& faults);

}  // namespace tunewright::api
