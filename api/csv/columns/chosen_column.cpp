#include "api/csv/columns/chosen_column.h"

#include <algorithm>

#include "api/csv/columns/column_refusals.h"

namespace tunewright::api {
namespace {

std::optional<std::size_t> by_number(const ColumnFacts& facts, Role role, int number, std::vector<CsvFault>& faults) {
    if (number >= 1 && static_cast<std::size_t>(number) <= facts.size()) return static_cast<std::size_t>(number) - 1;
    faults.push_back(column_fault(role, role_name(role) + " is column " + std::to_string(number) +
                                            "; the csv has columns 1 to " + std::to_string(facts.size()) + "."));
    return std::nullopt;
}

std::optional<std::size_t> loosely(const ColumnFacts& facts, Role role, const std::string& text,
                                   std::vector<CsvFault>& faults) {
    std::optional<std::size_t> found;
    const std::string wanted = lower_case(trimmed(text));
    const auto& headings = facts.layout().headings;
    for (std::size_t i = 0; i < headings.size(); ++i) {
        if (lower_case(headings[i]) != wanted && facts.heading(i).name != wanted) continue;
        if (found) {
            faults.push_back(column_fault(role, role_name(role) + " is " + quoted(text) +
                                                    ", which fits several headings: " + facts.headings_listed() +
                                                    ". Write the heading in full."));
            return std::nullopt;
        }
        found = i;
    }
    if (!found)
        faults.push_back(column_fault(role, role_name(role) + " is " + quoted(text) +
                                                ", which is not a heading; the headings are " +
                                                facts.headings_listed() + "."));
    return found;
}

}  // namespace

std::optional<std::size_t> chosen_column(const ColumnFacts& facts, Role role, const ColumnChoice& choice,
                                         std::vector<CsvFault>& faults) {
    if (const int* number = std::get_if<int>(&choice)) return by_number(facts, role, *number, faults);
    const std::string& text = std::get<std::string>(choice);
    const auto& headings = facts.layout().headings;
    if (headings.empty()) {
        faults.push_back(column_fault(role, role_name(role) + " is " + quoted(text) +
                                                ", but the first line of the csv has no headings; give column numbers "
                                                "from 1, or add a heading line."));
        return std::nullopt;
    }
    const auto exact = std::find(headings.begin(), headings.end(), text);
    if (exact != headings.end()) return static_cast<std::size_t>(exact - headings.begin());
    return loosely(facts, role, text, faults);
}

}  // namespace tunewright::api
