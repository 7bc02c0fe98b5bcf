// Files of which no column can be told, though each has its heading: what is wrong with them, and the cure.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "api/csv/columns/column_facts.h"
#include "api/csv/record.h"

namespace tunewright::api {

/// Historians and databases export one line for each tag and time.
std::optional<CsvFault> one_line_a_tag(const ColumnFacts& facts);

/// Historians also export each tag with its own times: values in one row do not belong together. `value` is u or y.
std::optional<CsvFault> two_clocks(const ColumnFacts& facts, std::size_t time, std::size_t value);

/// What is said where the first headings are believed to be those of the values, and where they are not.
std::string surplus_note(const CsvLayout& layout);
CsvFault surplus_fault(const CsvLayout& layout);

}  // namespace tunewright::api
