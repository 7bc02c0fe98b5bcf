// Columns of a CSV of loops about the loop's controller and today's settings, as `implement` and `baseline` of the
// loop's request take them.
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

/// A column of today's settings: a member of a controller (Kp, Ti, Td, Tf, b, form ...), or a setting by the product's
/// own name; or of the loop's controller: the product's id, an end of its ranges, its sample time.
struct TodaysColumn {
    std::string name;    ///< as written, without "today" in front and without its unit
    std::string member;  ///< path in `baseline` or `implement`, "filter/Tf"; "" for a setting of a product
    std::string unit;
    std::size_t cell = 0;

    bool is_of_controller() const;  ///< a member of `implement`
    bool is_time() const { return member == "Ti" || member == "Td" || member == "filter/Tf"; }
};

/// Recognises "Kp", "Ti [min]", "today Kp", "product", "y low", "today GAIN"; empty for another heading.
std::optional<TodaysColumn> todays_column(const Heading& heading);

/// The members of `implement` that one loop has; an object, empty if it has none. A cell that should hold a number and
/// does not is a fault.
Json own_controller(const std::vector<TodaysColumn>& columns, const std::vector<std::string_view>& cells,
                    DecimalSign sign, std::vector<FieldError>& faults);

/// `baseline` of one loop; null if all of its cells are empty. `product`: that of the loop; with one, every column is
/// one of its settings. Faults as above.
Json todays_settings(const std::vector<TodaysColumn>& columns, const std::vector<std::string_view>& cells,
                     DecimalSign sign, const std::string& product, std::vector<FieldError>& faults);

}  // namespace tunewright::api
