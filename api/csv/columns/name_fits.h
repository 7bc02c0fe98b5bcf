// The columns whose headings name a role, and what narrows them down: whether they move, and whose names go together.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading.h"

namespace tunewright::api {

struct NameFits {
    std::vector<std::size_t> best;    ///< columns that name the role most plainly, all equally so
    std::vector<std::size_t> others;  ///< columns with a name of the role that is less plain
};

/// The plainest name wins; tags that end alike are not guessed among, so `best` may hold several. `free` says whether a
/// column may have the role.
NameFits fits_by_name(const ColumnFacts& facts, Role role, const std::function<bool(std::size_t)>& free);

/// Keeps the columns that move where some do: one that stands still was neither driven nor did it respond. Adds a note
/// about those that were passed over.
void keep_moving(const ColumnFacts& facts, NameFits& fits, std::vector<std::string>& notes);

/// Keeps the one column that shares `same` (stem or number_behind) with `column`, if there is exactly one.
void keep_beside(const ColumnFacts& facts, std::size_t column, std::string (*same)(const Heading&), NameFits& fits);

/// ", which ...": the other columns that may have been meant, and how to choose them. "" where there are none.
std::string rivals(const ColumnFacts& facts, Role role, const NameFits& fits);

}  // namespace tunewright::api
