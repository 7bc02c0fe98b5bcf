// Columns by their names: the one that a request names for a role, and those whose headings name a role. The latter are
// narrowed down by their motion and by names that belong together.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading.h"
#include "api/csv/csv_record.h"

namespace tunewright::api {

/// The column that a request names, by its heading or its number from 1. A heading is matched exactly, else without
/// regard to letter case, unit and blanks. If the file has no such column, or several, the result is empty and a fault
/// is added.
std::optional<std::size_t> chosen_column(const ColumnFacts& facts, ColumnRole role, const ColumnChoice& choice,
                                         std::vector<CsvFault>& faults);

/// The columns that a request names as measured disturbances. One that has a role in `at` already, or is named twice,
/// is a fault.
std::vector<std::size_t> chosen_disturbances(const ColumnFacts& facts, const std::vector<ColumnChoice>& choices,
                                             const std::array<std::optional<std::size_t>, kRoleCount>& at,
                                             std::vector<CsvFault>& faults);

struct NameFits {
    std::vector<std::size_t> best;    ///< columns that name the role most clearly, all equally
    std::vector<std::size_t> others;  ///< columns that name the role less clearly
};

/// The clearest name wins; there is no guess among tags that end alike, so `best` may hold several. `free` is true for
/// columns that may have the role.
NameFits fits_by_name(const ColumnFacts& facts, ColumnRole role, const std::function<bool(std::size_t)>& free);

/// Keeps the columns that move, if some do: one that stands still neither acted nor responded. Adds a note about those
/// that were left out.
void keep_moving(const ColumnFacts& facts, NameFits& fits, std::vector<std::string>& notes);

/// Keeps the one column with the same `same` (stem or number_behind) as `column`, if there is exactly one.
void keep_partner(const ColumnFacts& facts, std::size_t column, std::string (*same)(const Heading&), NameFits& fits);

/// ", which ...": the other columns that may be meant, and how to choose them. "" if there are none.
std::string rivals(const ColumnFacts& facts, ColumnRole role, const NameFits& fits);

}  // namespace tunewright::api
