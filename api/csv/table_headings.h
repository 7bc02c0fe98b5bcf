// Which line of a table holds its headings, and which hold data.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "api/csv/table.h"

namespace tunewright::api {

/// Cells up to the last one that is not empty.
std::size_t filled(const std::vector<std::string_view>& cells);

/// The number of cells that most lines have; of equally many the larger.
std::size_t usual_width(const std::vector<CsvLine>& lines);

/// At least half of the cells hold numbers, times or marks of missing values, and there are about `width` of them.
bool is_data(const CsvLine& line, std::size_t width);
/// The same for lines as wide as usual, or as the headings.
bool is_data_of(const CsvLine& line, std::size_t usual, std::size_t width);
/// No cell holds a number or a time, and not all are missing.
bool is_text(const CsvLine& line);

/// Those that have a cell which is not empty.
std::vector<CsvLine> filled_lines(std::vector<CsvLine> lines);

/// The first line of data. A date or a number among the lines of a title is none: headings come behind it.
std::vector<CsvLine>::const_iterator first_data(const std::vector<CsvLine>& lines, std::size_t usual,
                                                std::size_t width);

/// How many of the cells name a role, as headings.
int roles_named(const std::vector<std::string_view>& cells);

/// The cells of this line are the headings.
void take_headings(const CsvLine& line, CsvLayout& layout);

/// The lines of text right above the data that are as wide as it is: takes the headings from them into `layout`.
void find_headings(const std::vector<CsvLine>& above, const std::vector<CsvLine>& data, CsvLayout& layout);

/// "# t,u,y" and "#,Time,PV": the heading line of those who write headings as comments, or number their rows. Blanks
/// part the words of any sentence too, so one of them must name a role.
std::optional<CsvLine> commented_headings(int number, std::string_view line, CsvLayout& layout);

/// Rows that end where their last value is: the headings and the longest rows show how many columns there are.
void widen_to_headings(const std::vector<CsvLine>& lines, CsvLayout& layout);

}  // namespace tunewright::api
