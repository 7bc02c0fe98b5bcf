#include "api/csv/record_notes.h"

#include <algorithm>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading.h"

namespace tunewright::api {

namespace {

/// "C:\\data\\step.csv": one word that ends as files do.
bool is_file_name(std::string_view line) {
    constexpr std::string_view kEndings[] = {".csv", ".txt", ".tsv", ".dat", ".log", ".json", ".xlsx"};
    return std::ranges::any_of(kEndings, [&](std::string_view ending) { return line.ends_with(ending); });
}

}  // namespace

std::string no_data_sentence(const CsvLayout& layout, std::string_view first_line) {
    if (layout.lines_of_text == 0) return "csv is empty; it needs a heading line such as t,u,y and lines of numbers.";
    for (const std::string& text : layout.headings) {
        for (const ColumnRole role : {kTimeRole, kInputRole, kOutputRole}) {
            const auto named = match(split_heading(text), role);
            if (named && named->level == 1) return "csv has headings but no line of numbers.";
        }
    }
    if (layout.lines_of_text == 1 && is_file_name(first_line))
        return "csv is " + in_quotes(first_line) +
               ", the name of a file; it must be the content of the file, its lines.";
    return "csv has neither lines of numbers in columns nor lines that each name two or more values; it begins with " +
           in_quotes(first_line) +
           ". Export a heading line such as t,u,y and one line per sample, with all its values.";
}

std::string sign_note(const CsvLayout& layout) {
    const std::string& open = layout.open_number;
    const bool comma = open.find(',') != std::string::npos;
    const bool of_thousands = layout.sign == (comma ? DecimalSign::point : DecimalSign::comma);
    if (!open.empty() && layout.sign == DecimalSign::either)
        return "Numbers such as " + in_quotes(open) +
               " are read with three decimals. If they are thousands, write them without the " +
               (comma ? "comma." : "point.");
    if (!open.empty() && of_thousands)
        return "Numbers such as " + in_quotes(open) +
               " are read as thousands, because the column also contains whole numbers.";
    return layout.sign == DecimalSign::comma ? "Numbers have a decimal comma." : "";
}

std::string unit_of(const CsvLayout& layout, const ColumnProfile& profile, std::size_t column) {
    std::string unit = column < layout.headings.size() ? split_heading(layout.headings[column]).unit : "";
    if (unit.empty() && !layout.below.empty() && column < layout.below.front().cells.size())
        unit = std::string(layout.below.front().cells[column]);
    return unit.empty() ? profile.suffix : unit;
}

bool is_percent(const CsvLayout& layout, const ColumnProfile& profile, std::size_t column) {
    const bool below = std::ranges::any_of(
        layout.below, [&](const CsvLine& line) { return column < line.cells.size() && line.cells[column] == "%"; });
    return below || profile.suffix == "%" ||
           (column < layout.headings.size() && is_percent(split_heading(layout.headings[column])));
}

std::string switch_note(const std::string& low_word, const std::string& high_word) {
    std::string levels;
    if (!low_word.empty()) levels = in_quotes(low_word) + " is 0";
    if (!high_word.empty()) levels += (levels.empty() ? "" : " and ") + in_quotes(high_word) + " is 1";
    return levels.empty() ? "" : "u is two levels: " + levels + ". The gain is per switch, not per unit of power.";
}

}  // namespace tunewright::api
