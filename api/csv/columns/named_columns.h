// Columns by their names: the one that a request names for a role, and those whose headings name a role. Whether they
// move, and whose names go together, narrows the latter down.
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

/// The column that a request names, by its heading or its number from 1. A heading is found as it is written, else
/// without regard to letter case, unit and blanks. Where the file has no such column, or several, the result is empty
/// and a fault is added that says so.
std::optional<std::size_t> chosen_column(const ColumnFacts& facts, ColumnRole role, const ColumnChoice& choice,
                                         std::vector<CsvFault>& faults);

/// The same for the measured disturbances. One that has a role in `at` already, or is named twice, is a fault.
std::vector<std::size_t> chosen_disturbances(const ColumnFacts& facts, const std::vector<ColumnChoice>& choices,
                                             const std::array<std::optional<std::size_t>, kRoleCount>& at,
                                             std::vector<CsvFault>& faults);

struct NameFits {
    std::vector<std::size_t> best;    ///< columns that name the role most plainly, all equally so
    std::vector<std::size_t> others;  ///< columns with a name of the role that is less plain
};

/// The plainest name wins; tags that end alike are not guessed among, so `best` may hold several. `free` says whether a
/// column may have the role.
NameFits fits_by_name(const ColumnFacts& facts, ColumnRole role, const std::function<bool(std::size_t)>& free);

/// Keeps the columns that move where some do: one that stands still was neither driven nor did it respond. Adds a note
/// about those that were passed over.
void keep_moving(const ColumnFacts& facts, NameFits& fits, std::vector<std::string>& notes);

/// Keeps the one column that shares `same` (stem or number_behind) with `column`, if there is exactly one.
void keep_beside(const ColumnFacts& facts, std::size_t column, std::string (*same)(const Heading&), NameFits& fits);

/// ", which ...": the other columns that may have been meant, and how to choose them. "" where there are none.
std::string rivals(const ColumnFacts& facts, ColumnRole role, const NameFits& fits);

}  // namespace tunewright::api
