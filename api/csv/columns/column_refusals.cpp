#include "api/csv/columns/column_refusals.h"

#include <utility>

#include "api/describe/suggest.h"

namespace tunewright::api {
namespace {

std::vector<std::string> quoted_all(const std::vector<std::string>& texts) {
    std::vector<std::string> out;
    out.reserve(texts.size());
    for (const std::string& text : texts) out.push_back(in_quotes(text));
    return out;
}

// The counts as text: "Line 1 has 13 headings and the rows have 8 values".
std::string surplus_counted(const CsvLayout& layout) {
    return "Line " + std::to_string(layout.heading_line) + " has " +
           std::to_string(layout.headings.size() + layout.surplus.size()) + " headings and the rows have " +
           std::to_string(layout.headings.size()) + " values";
}

}  // namespace

std::optional<CsvFault> two_clocks(const ColumnFacts& facts, std::size_t time, std::size_t value) {
    if (value == 0 || value - 1 == time) return std::nullopt;
    const std::size_t left = value - 1;
    if (!facts.is_clock(left) || !run_apart(facts.text(), facts.layout(), time, left)) return std::nullopt;
    return CsvFault{
        "csv",
        "csv has two columns of times: " + facts.shown(value) + " has its own times in " + facts.shown(left) +
            ", which differ from those of " + facts.shown(time) +
            ". Export all tags at common times (sampled or interpolated data), so that u and y are in one line."};
}

CsvFault column_fault(ColumnRole role, std::string message) {
    return {"columns/" + role_name(role), std::move(message)};
}

CsvFault several_columns(const ColumnFacts& facts, ColumnRole role, const std::vector<std::size_t>& columns) {
    return column_fault(role, "Several columns may be " + role_name(role) + " (" + role_meaning(role) +
                                  "): " + facts.shown(columns) + ". Choose one.");
}

CsvFault names_apart(const ColumnFacts& facts, std::size_t u, std::size_t y) {
    return column_fault(kOutputRole, facts.shown(u) + " and " + facts.shown(y) +
                                         " have names that do not belong together. Choose the column of u, the "
                                         "controller output, and that of y, the measurement.");
}

CsvFault missing_column(const ColumnFacts& facts, ColumnRole role) {
    const std::string said = facts.layout().headings.empty() ? "The file has no headings."
                                                             : "The headings are " + facts.headings_listed() + ".";
    if (role == kTimeRole)
        return column_fault(role, "No time column found. Choose one or enter the sampling time. " + said);
    const bool without_input = role == kInputRole && facts.size() <= 2;
    return column_fault(role,
                        "No column is clearly " + role_name(role) + ", " + role_meaning(role) +
                            (without_input ? ". If the file has none and u stepped at the first row, give u_step, "
                                             "[from, to]. "
                                           : ". Choose its heading, or its number from 1. ") +
                            said);
}

CsvFault equal_columns(ColumnRole role, ColumnRole other) {
    return column_fault(role, role_name(role) + " and " + role_name(other) + " are the same column; choose another.");
}

CsvFault step_with_column(const ColumnFacts& facts, const std::vector<std::size_t>& columns) {
    return {"u_step", "u_step is for a file without u, and the file has " + facts.shown(columns) +
                          ". Remove u_step; if that is another quantity, rename the column."};
}

std::string columns_unread(const ColumnFacts& facts, const std::vector<std::size_t>& columns) {
    return facts.shown(columns) + " may be u and " + (columns.size() == 1 ? "was" : "were") +
           " not read, because u_step gives u. If the file has u, remove u_step and choose its column.";
}

std::string codes_without_meaning(const ColumnFacts& facts, std::size_t column) {
    return "Column " + facts.shown(column) +
           " holds numbers, and its heading does not say which is automatic: the mode is not read. Name it such as "
           "\"Mode (0=MAN, 1=AUTO)\".";
}

std::string surplus_note(const CsvLayout& layout) {
    return surplus_counted(layout) + ": they are read as those of the first " + std::to_string(layout.headings.size()) +
           " headings, and " + listed(quoted_all(layout.surplus), "and") +
           (layout.surplus.size() == 1 ? " has none." : " have none.");
}

CsvFault surplus_fault(const CsvLayout& layout) {
    std::vector<std::string> headings = layout.headings;
    headings.insert(headings.end(), layout.surplus.begin(), layout.surplus.end());
    return {"csv", surplus_counted(layout) + ", so it is not known which heading belongs to which column: headings " +
                       listed(quoted_all(headings), "and") + "; values " + listed(quoted_all(layout.first), "and") +
                       ". Give each column one heading."};
}

}  // namespace tunewright::api
