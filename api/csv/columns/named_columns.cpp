#include "api/csv/columns/named_columns.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "api/csv/columns/column_refusals.h"

namespace tunewright::api {
namespace {

std::optional<std::size_t> by_number(const ColumnFacts& facts, ColumnRole role, int number,
                                     std::vector<CsvFault>& faults) {
    if (number >= 1 && static_cast<std::size_t>(number) <= facts.size()) return static_cast<std::size_t>(number) - 1;
    faults.push_back(column_fault(role, role_name(role) + " is column " + std::to_string(number) +
                                            "; the csv has columns 1 to " + std::to_string(facts.size()) + "."));
    return std::nullopt;
}

std::optional<std::size_t> loosely(const ColumnFacts& facts, ColumnRole role, const std::string& text,
                                   std::vector<CsvFault>& faults) {
    std::optional<std::size_t> found;
    const std::string wanted = lower_case(trimmed(text));
    const auto& headings = facts.layout().headings;
    for (std::size_t i = 0; i < headings.size(); ++i) {
        if (lower_case(headings[i]) != wanted && facts.heading(i).name != wanted) continue;
        if (found) {
            faults.push_back(column_fault(role, role_name(role) + " is " + in_quotes(text) +
                                                    ", which fits several headings: " + facts.headings_listed() +
                                                    ". Write the heading in full."));
            return std::nullopt;
        }
        found = i;
    }
    if (!found)
        faults.push_back(column_fault(role, role_name(role) + " is " + in_quotes(text) +
                                                ", which is not a heading; the headings are " +
                                                facts.headings_listed() + "."));
    return found;
}

}  // namespace

std::optional<std::size_t> chosen_column(const ColumnFacts& facts, ColumnRole role, const ColumnChoice& choice,
                                         std::vector<CsvFault>& faults) {
    if (const auto* number = std::get_if<int>(&choice)) return by_number(facts, role, *number, faults);
    const auto& text = std::get<std::string>(choice);
    const auto& headings = facts.layout().headings;
    if (headings.empty()) {
        faults.push_back(column_fault(role, role_name(role) + " is " + in_quotes(text) +
                                                ", but the first line of the csv has no headings; give column numbers "
                                                "from 1, or add a heading line."));
        return std::nullopt;
    }
    const auto exact = std::find(headings.begin(), headings.end(), text);
    if (exact != headings.end()) return static_cast<std::size_t>(exact - headings.begin());
    return loosely(facts, role, text, faults);
}

std::vector<std::size_t> chosen_disturbances(const ColumnFacts& facts, const std::vector<ColumnChoice>& choices,
                                             const std::array<std::optional<std::size_t>, kRoleCount>& at,
                                             std::vector<CsvFault>& faults) {
    std::vector<std::size_t> found;
    for (const ColumnChoice& choice : choices) {
        const auto column = chosen_column(facts, kDisturbanceRole, choice, faults);
        if (!column) continue;
        for (const ColumnRole role : kRoles) {
            if (at[role] == column) faults.push_back(equal_columns(kDisturbanceRole, role));
        }
        if (std::find(found.begin(), found.end(), *column) != found.end())
            faults.push_back(column_fault(kDisturbanceRole,
                                          "d names column " + facts.shown(*column) + " twice; name each column once."));
        found.push_back(*column);
    }
    return found;
}

NameFits fits_by_name(const ColumnFacts& facts, ColumnRole role, const std::function<bool(std::size_t)>& free) {
    std::optional<NameMatch> best;
    NameFits fits;
    for (std::size_t i = 0; i < facts.layout().headings.size(); ++i) {
        if (!free(i)) continue;
        const auto now = match(facts.heading(i), role);
        if (!now) continue;
        if (!best || now->level < best->level ||
            (now->level == best->level && now->level == 1 && now->order < best->order)) {
            if (best && best->level == 1) fits.others.insert(fits.others.end(), fits.best.begin(), fits.best.end());
            best = now;
            fits.best = {i};
        } else if (now->level == best->level && (now->level > 1 || now->order == best->order)) {
            fits.best.push_back(i);
        } else if (now->level == 1) {
            fits.others.push_back(i);
        }
    }
    return fits;
}

void keep_moving(const ColumnFacts& facts, NameFits& fits, std::vector<std::string>& notes) {
    if (fits.best.size() < 2) return;
    std::vector<std::size_t> moving, rest;
    int lines = 0;
    for (const std::size_t i : fits.best) {
        (facts.profile(i).changes > 0 ? moving : rest).push_back(i);
        lines = std::max(lines, facts.profile(i).numbers);
    }
    if (moving.empty() || rest.empty()) return;
    const std::string until = lines < kProfiledLines ? "" : " in the first " + std::to_string(lines) + " lines";
    notes.push_back(facts.shown(rest) + (rest.size() == 1 ? " does" : " do") + " not move" + until + " and " +
                    (rest.size() == 1 ? "was" : "were") + " passed over.");
    fits.best = std::move(moving);
}

void keep_partner(const ColumnFacts& facts, std::size_t column, std::string (*same)(const Heading&), NameFits& fits) {
    const std::string own = same(facts.heading(column));
    std::vector<std::size_t> kept, rest;
    for (const std::size_t i : fits.best) (same(facts.heading(i)) == own ? kept : rest).push_back(i);
    if (own.empty() || kept.size() != 1 || rest.empty()) return;
    fits.best = std::move(kept);
    fits.others.insert(fits.others.end(), rest.begin(), rest.end());
}

std::string rivals(const ColumnFacts& facts, ColumnRole role, const NameFits& fits) {
    if (role == kTimeRole || fits.others.empty()) return "";
    std::vector<std::size_t> moving;
    for (const std::size_t i : fits.others) {
        if (facts.profile(i).changes > 0) moving.push_back(i);
    }
    if (moving.empty()) return "";
    const std::string why = role == kOutputRole && is_measured(facts.heading(fits.best.front()))
                                ? ", as the measured one; it may also be "
                                : "; it may also be ";
    return why + facts.shown(moving) + ", if you choose " + (moving.size() == 1 ? "it" : "one of them");
}

}  // namespace tunewright::api
