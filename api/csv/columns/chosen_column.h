// The column that a request names, by its heading or its number, for one role.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading.h"
#include "api/csv/record.h"

namespace tunewright::api {

/// A heading is found as it is written, else without regard to letter case, unit and blanks. Where the file has no
/// such column, or several, the result is empty and a fault is added that says so.
std::optional<std::size_t> chosen_column(const ColumnFacts& facts, Role role, const ColumnChoice& choice,
                                         std::vector<CsvFault>& faults);

}  // namespace tunewright::api
