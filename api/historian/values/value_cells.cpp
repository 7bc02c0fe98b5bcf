#include "api/historian/values/value_cells.h"

#include <cmath>

#include "api/csv/columns/column_facts.h"
#include "api/historian/values/value_quality.h"

namespace tunewright::api {
namespace {

constexpr double kMaxNumber = 1e30;  // as in every number of the contract

}  // namespace

double ValueCells::read(std::string_view cell, bool bad) {
    double value = 0;
    if (cell.empty()) return kNoNumber;
    if (bad) return ++bad_, kNoNumber;
    if (read_cell_number(cell, value, sign_, suffix_) && std::abs(value) <= kMaxNumber) return value;
    if (suffix_.empty() && !unit_suffix(cell).empty()) {
        suffix_ = std::string(unit_suffix(cell));
        return read(cell, bad);
    }
    if (const auto level = words_ ? switch_word(cell) : std::nullopt) return *level;
    if (is_missing(cell) || is_bad_quality(cell)) return ++bad_, kNoNumber;
    if (unread_++ == 0) first_unread_ = std::string(cell);
    return kNoNumber;
}

std::string ValueCells::unread_note(const std::string& tag) const {
    if (unread_ == 0) return {};
    return std::to_string(unread_) + (unread_ == 1 ? " value of " : " values of ") + in_quotes(tag) +
           (unread_ == 1 ? " is not a number (" : " are not numbers, such as ") + in_quotes(first_unread_) +
           (unread_ == 1 ? "); it counts as missing." : "; they count as missing.");
}

}  // namespace tunewright::api
