#include "api/csv/columns/name_fits.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace tunewright::api {

NameFits fits_by_name(const ColumnFacts& facts, Role role, const std::function<bool(std::size_t)>& free) {
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

void keep_beside(const ColumnFacts& facts, std::size_t column, std::string (*same)(const Heading&), NameFits& fits) {
    const std::string own = same(facts.heading(column));
    std::vector<std::size_t> kept, rest;
    for (const std::size_t i : fits.best) (same(facts.heading(i)) == own ? kept : rest).push_back(i);
    if (own.empty() || kept.size() != 1 || rest.empty()) return;
    fits.best = std::move(kept);
    fits.others.insert(fits.others.end(), rest.begin(), rest.end());
}

std::string rivals(const ColumnFacts& facts, Role role, const NameFits& fits) {
    if (role == kTimeRole || fits.others.empty()) return "";
    std::vector<std::size_t> moving;
    for (const std::size_t i : fits.others) {
        if (facts.profile(i).changes > 0) moving.push_back(i);
    }
    if (moving.empty()) return "";
    const std::string why = role == kOutputRole && is_measured(facts.heading(fits.best.front()))
                                ? ", as the measured one; it may also be "
                                : "; it may also be ";
    return why + facts.shown(moving) + ", which columns." + role_name(role) + " chooses";
}

}  // namespace tunewright::api
