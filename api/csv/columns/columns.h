// The columns of a CSV file that hold time, controller output and measurement.
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

struct DetectedColumns {
    std::array<std::optional<std::size_t>, kRoleCount> at;
    std::optional<std::size_t> clock;           ///< a second column of times of day, if at[kTimeRole] holds dates only
    std::optional<std::size_t> spacing_column;  ///< instead of times: the column with the spacing of samples
    std::optional<FileSpacing> spacing;         ///< instead of times: from that column, or from a line above the data
    std::vector<std::size_t> d;                 ///< measured disturbances, as chosen
    std::vector<std::string> notes;
    std::string unread;  ///< a sentence about columns that may be u if CsvOptions::u_step is given; "" for none
};

/// The columns of time, u, y, the set point r and the mode. Each step only decides roles that the previous steps left
/// open. A role that stays open is a fault that lists the headings.
///
///  1. The columns that the request names, with measured disturbances.
///  2. The controller's own terms (P, I, D) are excluded: none of them is u or y.
///  3. Headings that identify u and y only as a pair, such as x and y with w; the spacing of samples, in a column or
///     above the data, instead of times.
///  4. Time by its heading.
///  5. u and y by their headings: u and y with a common name; then each by the words of its role (heading_words): the
///     best fit, among equal fits those that move, and those that share a stem or number.
///  6. A date and a time of day in two columns are joined.
///  7. By content, if headings do not decide: time holds stamps or rises; u switches or stays on its levels while y
///     moves; the only column left.
///  8. The set point and the mode of the loop: reported if they are found, and never u or y.
///  9. Checks: all roles found, none twice, one clock, no more headings than values.
///
/// The order matters: a column that a later step takes by its content must not have been named before.
DetectedColumns find_columns(std::string_view text, const CsvLayout& layout, const std::vector<ColumnProfile>& profiles,
                             const CsvOptions& options, std::vector<CsvFault>& faults);

}  // namespace tunewright::api
