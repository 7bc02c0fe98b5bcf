// Sentences about a file that the reader of records says.
#pragma once

#include <string>
#include <string_view>

#include "api/csv/columns/column_profile.h"
#include "api/csv/table.h"

namespace tunewright::api {

/// Why a file without a line of data cannot be read: it is empty, it has headings alone, or its lines are no rows;
/// `first_line` is the file's, which is shown then.
std::string no_data_sentence(const CsvLayout& layout, std::string_view first_line);

/// That the decimal sign is a comma, or how numbers that may have three decimals or be thousands are read; "" where
/// neither needs saying.
std::string sign_note(const CsvLayout& layout);

/// Unit of a column as the file has it: in the heading, in the line below it or behind the numbers; "" if it has none.
std::string unit_of(const CsvLayout& layout, const ColumnProfile& profile, std::size_t column);

/// True if heading, a line below it or the numbers say percent: 0 to 100, never 0 to 1.
bool is_percent(const CsvLayout& layout, const ColumnProfile& profile, std::size_t column);

/// Which words of u are its two levels, "OFF" 0 and "ON" 1; "" where it has none. Either word may be "", where the file
/// shows one of them alone.
std::string switch_note(const std::string& low_word, const std::string& high_word);

}  // namespace tunewright::api
