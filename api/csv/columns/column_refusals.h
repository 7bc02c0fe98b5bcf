// Faults for columns that cannot be found: one sentence for each case, with its cure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading.h"
#include "api/csv/csv_record.h"

namespace tunewright::api {

/// The fault of an export in which each tag has its own times: values in one row do not belong together. `value` is u
/// or y.
std::optional<CsvFault> two_clocks(const ColumnFacts& facts, std::size_t time, std::size_t value);

/// A fault at the chosen column of a role: `where` is "columns/t" and so on.
CsvFault column_fault(ColumnRole role, std::string message);

/// The fault if several headings name the role equally well.
CsvFault several_columns(const ColumnFacts& facts, ColumnRole role, const std::vector<std::size_t>& columns);

/// The fault if the names of u and y are those of different devices.
CsvFault names_apart(const ColumnFacts& facts, std::size_t u, std::size_t y);

/// The fault if neither headings nor contents identify the column of the role.
CsvFault missing_column(const ColumnFacts& facts, ColumnRole role);

/// The fault if one column has both roles.
CsvFault equal_columns(ColumnRole role, ColumnRole other);

/// The fault if a step of u is given and the file has u in `columns`.
CsvFault step_with_column(const ColumnFacts& facts, const std::vector<std::size_t>& columns);

/// The note if a step of u is given and `columns` may be u: they are not read.
std::string columns_unread(const ColumnFacts& facts, const std::vector<std::size_t>& columns);

/// The sentence about a mode in numbers whose heading does not say which is automatic.
std::string codes_without_meaning(const ColumnFacts& facts, std::size_t column);

/// The note about surplus headings, whether the first ones are taken for those of the values or not.
std::string surplus_note(const CsvLayout& layout);
CsvFault surplus_fault(const CsvLayout& layout);

}  // namespace tunewright::api
