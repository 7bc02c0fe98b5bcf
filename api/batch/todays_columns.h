// Columns of a CSV of loops that hold today's settings, as `baseline` of the loop's request takes them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/cell.h"
#include "api/csv/columns/heading.h"
#include "api/json/json.h"
#include "api/json/problem.h"

namespace tunewright::api {

/// A column of today's settings: a member of a controller (Kp, Ti, Td, Tf, b, form ...), the product's id, an end of
/// its ranges, or a setting by the product's own name.
struct TodaysColumn {
    std::string name;    ///< as written, without "today" in front and without its unit
    std::string member;  ///< path in `baseline` of a controller, "filter/Tf"; "" for a setting of a product
    std::string unit;
    std::size_t cell = 0;

    bool is_time() const { return member == "Ti" || member == "Td" || member == "filter/Tf"; }
};

/// Recognises "Kp", "Ti [min]", "today Kp", "product", "y low", "today GAIN"; empty for another heading.
std::optional<TodaysColumn> todays_column(const Heading& heading);

/// `baseline` of one loop; null if all of its cells are empty. `product`: for rows that name none. With a product every
/// column other than its id and ranges is one of its settings. A cell that should hold a number and does not is a
/// fault.
Json todays_settings(const std::vector<TodaysColumn>& columns, const std::vector<std::string_view>& cells,
                     DecimalSign sign, const std::string& product, std::vector<FieldError>& faults);

}  // namespace tunewright::api
