// Finds the line of a table that holds its headings, and the lines that hold data.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "api/csv/table.h"

namespace tunewright::api {

/// Number of cells up to the last one that is not empty.
std::size_t filled(const std::vector<std::string_view>& cells);

/// The number of cells that most lines have; in a tie, the larger.
std::size_t usual_width(const std::vector<CsvLine>& lines);

/// True if at least half of the cells hold numbers, times or marks of missing values, and there are about `width` of
/// them.
bool is_data(const CsvLine& line, std::size_t width);
/// is_data for lines of the usual width, or of the width of the headings.
bool is_data_of(const CsvLine& line, std::size_t usual, std::size_t width);
/// True if no cell holds a number or a time, and not all are missing.
bool is_text(const CsvLine& line);

/// The lines that have a cell which is not empty.
std::vector<CsvLine> filled_lines(std::vector<CsvLine> lines);

/// The first line of data. A date or a number among the lines of a title is not data: headings follow it.
std::vector<CsvLine>::const_iterator first_data(const std::vector<CsvLine>& lines, std::size_t usual,
                                                std::size_t width);

/// Number of cells that, as headings, name a role.
int roles_named(const std::vector<std::string_view>& cells);

/// Takes the cells of this line as the headings.
void take_headings(const CsvLine& line, CsvLayout& layout);

/// Takes the headings into `layout` from the lines of text right above the data that are as wide as it.
void find_headings(const std::vector<CsvLine>& above, const std::vector<CsvLine>& data, CsvLayout& layout);

/// Headings that are written as a comment, "# t,u,y", or with numbered rows, "#,Time,PV". Any sentence has words
/// separated by blanks, so one of them must name a role.
std::optional<CsvLine> commented_headings(int number, std::string_view line, CsvLayout& layout);

/// For rows that end at their last value: the headings and the longest rows show the number of columns.
void widen_to_headings(const std::vector<CsvLine>& lines, CsvLayout& layout);

}  // namespace tunewright::api
