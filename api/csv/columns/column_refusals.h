// Why the columns of a file cannot be found: one sentence for each case, with the cure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading.h"
#include "api/csv/csv_record.h"

namespace tunewright::api {

/// Historians export each tag with its own times: values in one row do not belong together. `value` is u or y.
std::optional<CsvFault> two_clocks(const ColumnFacts& facts, std::size_t time, std::size_t value);

/// A fault at the choice of the role's column: `where` is "columns/t" and so on.
CsvFault column_fault(ColumnRole role, std::string message);

/// Several headings name the role equally plainly.
CsvFault several_columns(const ColumnFacts& facts, ColumnRole role, const std::vector<std::size_t>& columns);

/// u and y were found, but their names are those of different devices.
CsvFault names_apart(const ColumnFacts& facts, std::size_t u, std::size_t y);

/// Neither headings nor contents say which column has the role.
CsvFault missing_column(const ColumnFacts& facts, ColumnRole role);

/// One column has both roles.
CsvFault equal_columns(ColumnRole role, ColumnRole other);

/// A step of u is given, and the file has u in `columns`.
CsvFault step_beside_column(const ColumnFacts& facts, const std::vector<std::size_t>& columns);

/// A step of u is given, and `columns` may be u: they are not read.
std::string columns_unread(const ColumnFacts& facts, const std::vector<std::size_t>& columns);

/// What is said where the first headings are believed to be those of the values, and where they are not.
std::string surplus_note(const CsvLayout& layout);
CsvFault surplus_fault(const CsvLayout& layout);

}  // namespace tunewright::api
