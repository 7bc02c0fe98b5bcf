// Sentences of the record reader about a file.
#pragma once

#include <string>
#include <string_view>

#include "api/csv/columns/column_profile.h"
#include "api/csv/table.h"

namespace tunewright::api {

/// The reason why a file without a line of data cannot be read: it is empty, it has only headings, or its lines are not
/// rows; `first_line` is the file's, which is then quoted.
std::string no_data_sentence(const CsvLayout& layout, std::string_view first_line);

/// A note that the decimal sign is a comma, or how ambiguous numbers (three decimals or thousands) are read; "" if
/// neither is needed.
std::string sign_note(const CsvLayout& layout);

/// Unit of a column as the file has it: in the heading, in the line below it or behind the numbers; "" if it has none.
std::string unit_of(const CsvLayout& layout, const ColumnProfile& profile, std::size_t column);

/// True if heading, a line below it or the numbers state percent: 0 to 100, never 0 to 1.
bool is_percent(const CsvLayout& layout, const ColumnProfile& profile, std::size_t column);

/// A note on the two words that are the levels of u, "OFF" 0 and "ON" 1; "" if there are none. Either word may be "" if
/// the file has only one of them.
std::string switch_note(const std::string& low_word, const std::string& high_word);

}  // namespace tunewright::api
