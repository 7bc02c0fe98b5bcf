#include "api/csv/columns/columns.h"

#include <algorithm>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/column_pairs.h"
#include "api/csv/columns/column_refusals.h"
#include "api/csv/columns/loop_mode.h"
#include "api/csv/columns/named_columns.h"

namespace tunewright::api {
namespace {

class ColumnFinder {
public:
    ColumnFinder(std::string_view text, const CsvLayout& layout, const std::vector<ColumnProfile>& profiles,
                 const CsvOptions& options, std::vector<CsvFault>& faults)
        : facts_(text, layout, profiles), layout_(layout), profiles_(profiles), options_(options), faults_(faults) {}

    DetectedColumns find() {
        const std::array<const std::optional<ColumnChoice>*, kRoleCount> choices = {
            &options_.columns.t, &options_.columns.u, &options_.columns.y, &options_.columns.r, &options_.columns.mode};
        for (const ColumnRole role : kRoles) {
            if (*choices[role]) found_.at[role] = chosen_column(facts_, role, **choices[role], faults_);
        }
        found_.d = chosen_disturbances(facts_, options_.columns.d, found_.at, faults_);
        if (!faults_.empty()) return found_;
        chosen_ = found_.at;
        find_terms();
        if (const auto letters = fold_umlauts(facts_)) take_pair(*letters);
        find_spacing();
        refuse_step_with_column();
        if (wanted(kTimeRole)) take_fitting(kTimeRole, fits(kTimeRole));
        read_input_with_output();
        if (!faults_.empty()) return found_;
        read_input_and_output();
        if (!faults_.empty()) return found_;
        join_date_and_clock();
        if (wanted(kTimeRole)) time_by_content();
        if (wanted(kTimeRole)) found_.spacing = spacing_above(facts_.text(), layout_);
        rest_by_content();
        find_reference();
        find_mode();
        for (const ColumnRole role : {kTimeRole, kInputRole, kOutputRole}) {
            if (wanted(role)) faults_.push_back(missing_column(facts_, role));
        }
        refuse_equal_columns();
        if (faults_.empty()) check_clocks();
        check_surplus();
        return found_;
    }

private:
    bool wanted(ColumnRole role) const {
        if (role == kTimeRole && (options_.dt || found_.spacing)) return false;
        return !found_.at[role] && !(role == kInputRole && options_.u_step);
    }

    bool taken(std::size_t column) const {
        return found_.clock == column || std::ranges::find(found_.d, column) != found_.d.end() ||
               std::find(found_.at.begin(), found_.at.end(), column) != found_.at.end();
    }

    bool is_term(std::size_t column) const { return std::find(terms_.begin(), terms_.end(), column) != terms_.end(); }

    bool may_be(std::size_t column, ColumnRole role) const {
        if (taken(column) || found_.spacing_column == column) return false;
        const ColumnProfile& p = profiles_[column];
        if (role == kTimeRole) return facts_.may_be_time(column);
        const bool numeric = p.numbers + p.missing > 0 && rare(p.stamps, p) && rare(p.switches, p) &&
                             (p.texts == 0 || facts_.holds_numbers(column));
        if (role == kReferenceRole) return numeric && p.numbers > 0 && !is_term(column);
        if (role == kModeRole) return holds_modes(column);
        if (is_term(column)) return false;
        if (role == kInputRole && is_never_input(facts_.heading(column))) return false;
        if (role == kInputRole && facts_.switches(column))
            return !match(facts_.heading(column), kReferenceRole) &&
                   (!is_auxiliary(facts_.heading(column)) || is_state(facts_.heading(column)));
        return numeric && !is_auxiliary(facts_.heading(column));
    }

    /// Words, most of them known, or numbers whose meaning the heading gives.
    bool holds_modes(std::size_t column) const {
        const ColumnProfile& p = profiles_[column];
        if (p.texts > 0) return 2 * p.modes > p.texts;
        return p.numbers + p.switches > 0 && p.stamps == 0 && !mode_codes(facts_.heading(column)).empty();
    }

    /// True if no cell is of this kind, or so few that they are damaged cells.
    static bool rare(int count, const ColumnProfile& p) { return count == 0 || kDamagedShare * count <= p.numbers; }

    void take(ColumnRole role, std::size_t column, const std::string& why = "") {
        found_.at[role] = column;
        if (why.empty() && facts_.heading(column).name == role_name(role)) return;
        found_.notes.push_back("Column " + facts_.shown(column) + " is read as " + role_name(role) + ", " +
                               role_meaning(role) + why + ".");
    }

    NameFits fits(ColumnRole role) const {
        return fits_by_name(facts_, role, [&](std::size_t column) { return may_be(column, role); });
    }

    void take_fitting(ColumnRole role, const NameFits& fits) {
        if (fits.best.size() == 1 || (role == kTimeRole && !fits.best.empty())) {
            take(role, fits.best.front(), rivals(facts_, role, fits));
            return;
        }
        if (fits.best.empty()) return by_very_name(role);
        faults_.push_back(several_columns(facts_, role, fits.best));
    }

    // A quantity next to the process, such as humidity, is y only if no other column is.
    NameFits output_fits() const {
        const auto free = [&](std::size_t column) { return may_be(column, kOutputRole); };
        NameFits all = fits_by_name(facts_, kOutputRole, free);
        NameFits plain = fits_by_name(facts_, kOutputRole, [&](std::size_t column) {
            return free(column) && !is_never_input(facts_.heading(column));
        });
        if (plain.best.empty()) return all;
        for (const auto* left : {&all.best, &all.others}) {
            for (const std::size_t i : *left)
                if (is_never_input(facts_.heading(i))) plain.others.push_back(i);
        }
        return plain;
    }

    void read_input_and_output() {
        NameFits u = wanted(kInputRole) ? fits(kInputRole) : NameFits{};
        NameFits y = wanted(kOutputRole) ? output_fits() : NameFits{};
        keep_partners(u, y);
        if (wanted(kInputRole) && wanted(kOutputRole) && u.best.empty() && y.best.empty() && take_data_set()) return;
        // No controller moved a column that stands still: the contents of the other columns show whether this one is u.
        const bool still = u.best.size() == 1 && u.others.empty() && stands_still(u.best.front()) &&
                           (!wanted(kOutputRole) || y.best.size() == 1);
        if (wanted(kInputRole) && !still) take_fitting(kInputRole, u);
        if (wanted(kOutputRole)) take_fitting(kOutputRole, y);
        if (wanted(kInputRole) && faults_.empty()) take_command();
        refuse_strangers();
    }

    // Decides between columns that names leave open: first those that move, then those whose names belong together.
    // Tags of a table belong together only if one of them was chosen; "heater_bed.temp" of a log, and "Temperature 1",
    // always.
    void keep_partners(NameFits& u, NameFits& y) {
        keep_moving(facts_, u, found_.notes);
        keep_moving(facts_, y, found_.notes);
        const bool chosen = chosen_[kInputRole] || chosen_[kOutputRole];
        const auto known = [&](ColumnRole role, const NameFits& fits) {
            return chosen_[role]           ? chosen_[role]
                   : fits.best.size() == 1 ? std::optional(fits.best.front())
                                           : std::nullopt;
        };
        for (const auto same : {stem, number_behind}) {
            if (same == stem && !layout_.pairs && !chosen) continue;
            if (const auto column = known(kInputRole, u)) keep_partner(facts_, *column, same, y);
            if (const auto column = known(kOutputRole, y)) keep_partner(facts_, *column, same, u);
        }
    }

    // In a log of several heaters, the temperature of one does not respond to the power of another.
    void refuse_strangers() {
        if (!layout_.pairs || !found_.at[kInputRole] || !found_.at[kOutputRole]) return;
        if (chosen_[kInputRole] || chosen_[kOutputRole]) return;
        const std::string u = stem(facts_.heading(*found_.at[kInputRole])),
                          y = stem(facts_.heading(*found_.at[kOutputRole]));
        if (u.empty() || y.empty() || u == y) return;
        faults_.push_back(names_apart(facts_, *found_.at[kInputRole], *found_.at[kOutputRole]));
    }

    bool take_data_set() {
        const auto pair = data_set(facts_);
        if (pair) take_pair(*pair);
        return pair.has_value();
    }

    void read_input_with_output() {
        const auto found = input_with_output(facts_, [&](std::size_t column) { return may_be(column, kInputRole); });
        if (!wanted(kInputRole) || !wanted(kOutputRole)) return;
        if (const auto* pair = std::get_if<NamedPair>(&found)) take_pair(*pair);
        if (const auto* sentence = std::get_if<std::string>(&found))
            faults_.push_back(column_fault(kInputRole, *sentence));
    }

    void take_pair(const NamedPair& pair) {
        if (!wanted(kInputRole) || !wanted(kOutputRole)) return;
        take(kInputRole, pair.u, pair.why_u);
        take(kOutputRole, pair.y, pair.why_y);
        if (!pair.note.empty()) found_.notes.push_back(pair.note);
    }

    void check_clocks() {
        if (!found_.at[kTimeRole]) return;
        for (const ColumnRole role : {kInputRole, kOutputRole}) {
            if (!found_.at[role] || (found_.clock && *found_.clock + 1 == *found_.at[role])) continue;
            if (auto fault = two_clocks(facts_, *found_.at[kTimeRole], *found_.at[role]))
                return faults_.push_back(*std::move(fault));
        }
    }

    // If there are more headings than values, the first ones are used if they name time, u and y.
    void check_surplus() {
        if (layout_.surplus.empty()) return;
        bool plain = faults_.empty();
        for (const ColumnRole role : {kTimeRole, kInputRole, kOutputRole}) {
            if (!found_.at[role]) continue;
            const std::size_t at = *found_.at[role];
            const bool named = chosen_[role] || match(facts_.heading(at), role);
            const bool runs = role != kTimeRole || profiles_[at].stamps > 0 || profiles_[at].rises;
            plain = plain && named && runs;
        }
        if (plain)
            found_.notes.push_back(surplus_note(layout_));
        else
            faults_ = {surplus_fault(layout_)};
    }

    void find_terms() {
        int letters = 0;
        for (std::size_t i = 0; i < facts_.size(); ++i) letters += is_term_letter(facts_.heading(i)) ? 1 : 0;
        for (std::size_t i = 0; i < facts_.size(); ++i) {
            const bool chosen = std::find(chosen_.begin(), chosen_.end(), i) != chosen_.end();
            if (!chosen && is_controller_term(facts_.heading(i), letters > 1)) terms_.push_back(i);
        }
        if (terms_.empty()) return;
        found_.notes.push_back("The controller's own terms are in the file, " + facts_.shown(terms_) +
                               "; they are skipped.");
    }

    void find_spacing() {
        if (!wanted(kTimeRole)) return;
        for (std::size_t i = 0; i < facts_.size(); ++i) {
            auto spacing = taken(i) ? std::nullopt : spacing_in_column(facts_, i);
            if (!spacing) continue;
            for (std::size_t k = 0; k < facts_.size(); ++k) {
                if (k != i && may_be(k, kTimeRole) && match(facts_.heading(k), kTimeRole)) return;
            }
            found_.spacing_column = i;
            found_.spacing = std::move(spacing);
            return;
        }
    }

    // The set point is reported if the file has one; it is optional.
    void find_reference() {
        if (found_.at[kReferenceRole]) return;
        NameFits r = fits(kReferenceRole);
        if (r.best.empty()) {
            for (std::size_t i = 0; i < facts_.size(); ++i) {
                if (is_command(facts_.heading(i)) && may_be(i, kReferenceRole)) r.best.push_back(i);
            }
        }
        for (const ColumnRole role : {kOutputRole, kInputRole}) {
            for (const auto same : {stem, number_behind}) {
                if (found_.at[role]) keep_partner(facts_, *found_.at[role], same, r);
            }
        }
        if (r.best.size() == 1) return take(kReferenceRole, r.best.front());
        if (r.best.empty()) return;
        found_.notes.push_back("Several columns may be the set point: " + facts_.shown(r.best) +
                               "; none is read. Choose one if it is needed.");
    }

    // The mode is optional too.
    void find_mode() {
        if (found_.at[kModeRole]) return check_mode(*found_.at[kModeRole]);
        const NameFits mode = fits_by_name(facts_, kModeRole, [&](std::size_t column) {
            return may_be(column, kModeRole) && is_of_this_loop(facts_.heading(column));
        });
        if (mode.best.size() == 1) return take(kModeRole, mode.best.front());
        if (!mode.best.empty())
            found_.notes.push_back("Several columns may be the mode of the loop: " + facts_.shown(mode.best) +
                                   "; none is read. Choose one if it is needed.");
        for (std::size_t i = 0; i < facts_.size() && mode.best.empty(); ++i) {
            const bool codes = profiles_[i].numbers > 0 && profiles_[i].texts == 0 && !taken(i);
            if (codes && match(facts_.heading(i), kModeRole)) found_.notes.push_back(codes_without_meaning(facts_, i));
        }
    }

    // The tag of a mode is that of u, y or r, or these have none.
    bool is_of_this_loop(const Heading& mode) const {
        const std::string own = mode_stem(mode);
        bool others = false;
        for (const ColumnRole role : {kInputRole, kOutputRole, kReferenceRole}) {
            const std::string tag = found_.at[role] ? stem(facts_.heading(*found_.at[role])) : "";
            if (tag == own) return true;
            others = others || !tag.empty();
        }
        return own.empty() || !others;
    }

    // Numbers of a chosen column need a meaning.
    void check_mode(std::size_t column) {
        const ColumnProfile& p = profiles_[column];
        if (p.numbers > p.texts + p.switches && mode_codes(facts_.heading(column)).empty())
            faults_.push_back(column_fault(kModeRole, codes_without_meaning(facts_, column)));
    }

    // A given step that replaces a u of the file would be at another time than the real one.
    void refuse_step_with_column() {
        if (!options_.u_step) return;
        if (chosen_[kInputRole])
            return faults_.push_back(
                {"u_step", "u_step is for a file without u, and columns.u names a column. Remove one of them."});
        NameFits u = fits(kInputRole);
        std::erase_if(u.best, [&](std::size_t column) { return profiles_[column].changes == 0; });
        if (u.best.empty()) return;
        const auto level = match(facts_.heading(u.best.front()), kInputRole)->level;
        if (level == 1) return faults_.push_back(step_with_column(facts_, u.best));
        found_.unread = columns_unread(facts_, u.best);
    }

    // "cmd" is the command to the plant, if no other column is u.
    void take_command() {
        std::vector<std::size_t> commands;
        for (std::size_t i = 0; i < facts_.size(); ++i) {
            if (is_command(facts_.heading(i)) && may_be(i, kReferenceRole)) commands.push_back(i);
        }
        if (commands.size() == 1)
            take(kInputRole, commands.front(), " (no other column is; it may be the set point of an inner loop)");
    }

    // A column with exactly the role's name but without numbers: reading it shows which line is wrong.
    void by_very_name(ColumnRole role) {
        for (std::size_t i = 0; i < layout_.headings.size(); ++i) {
            if (role == kTimeRole && profiles_[i].numbers > 0) continue;
            const auto now = taken(i) ? std::nullopt : match(facts_.heading(i), role);
            if (now && now->level == 1) return take(role, i);
        }
    }

    void join_date_and_clock() {
        if (!found_.at[kTimeRole]) return;
        const ColumnProfile& p = profiles_[*found_.at[kTimeRole]];
        const bool dates = p.stamps > 0 && p.dates == p.stamps, clocks = p.stamps > 0 && p.clocks == p.stamps;
        if (!dates && !clocks) return;
        const std::size_t now = *found_.at[kTimeRole];
        for (const std::size_t other : {now + 1, now - 1}) {
            if (other >= profiles_.size() || taken(other)) continue;
            const ColumnProfile& q = profiles_[other];
            if (q.stamps == 0 || q.numbers > 0 || (dates ? q.clocks : q.dates) != q.stamps) continue;
            found_.at[kTimeRole] = dates ? now : other;
            found_.clock = dates ? other : now;
            found_.notes.emplace_back("Date and time of day are combined from two columns.");
            return;
        }
    }

    void time_by_content() {
        std::vector<std::size_t> stamps, rising;
        for (std::size_t i = 0; i < profiles_.size(); ++i) {
            if (taken(i)) continue;
            const ColumnProfile& p = profiles_[i];
            const bool index = facts_.is_index(i);
            if (p.stamps > 0 && kDamagedShare * (p.numbers + p.texts) <= p.stamps) stamps.push_back(i);
            if (p.numbers > 2 && p.rises && p.stamps == 0 && p.texts == 0 && !index) rising.push_back(i);
        }
        if (!stamps.empty()) {
            take(kTimeRole, stamps.front(), " (it holds time stamps)");
            return join_date_and_clock();
        }
        // In a file with headings, u and y may rise too; the time is usually the first column.
        if (!rising.empty() && (rising.size() == 1 || rising.front() == 0))
            take(kTimeRole, rising.front(), " (its numbers rise from line to line)");
    }

    void rest_by_content() {
        std::vector<ColumnRole> roles;
        std::vector<std::size_t> free, switching;
        for (const ColumnRole role : {kTimeRole, kInputRole, kOutputRole}) {
            if (wanted(role)) roles.push_back(role);
        }
        for (std::size_t i = 0; i < profiles_.size(); ++i) {
            if (facts_.is_index(i)) continue;
            if (may_be(i, kOutputRole) && profiles_[i].numbers > 0 && !is_spacing(facts_.heading(i)) &&
                !is_frequency(facts_.heading(i)))
                free.push_back(i);
            if (facts_.switches(i) && may_be(i, kInputRole)) switching.push_back(i);
        }
        if (wanted(kInputRole) && !wanted(kOutputRole)) take_moving_input(free, switching);
        if (wanted(kInputRole) && switching.size() == 1) {
            take(kInputRole, switching.front(), " (it switches)");
            std::erase(roles, kInputRole);
        }
        if (roles.size() == 1 && free.size() == 1 &&
            (roles.front() != kInputRole || may_be(free.front(), kInputRole)) &&
            (roles.front() != kTimeRole ||
             (!layout_.headings.empty() && profiles_[free.front()].changes > 0 && facts_.mostly_one_way(free.front()))))
            return take(roles.front(), free.front(), " (the only column left)");
        if (roles.size() != 2 || free.size() != 2 || roles.front() == kTimeRole) return;
        for (const auto& [u, y] : {std::pair{free[0], free[1]}, std::pair{free[1], free[0]}}) {
            if (!facts_.held(u, y) || !may_be(u, kInputRole)) continue;
            take(kInputRole, u, " (it stays on its levels)");
            take(kOutputRole, y, " (it moves)");
            return;
        }
    }

    bool stands_still(std::size_t column) const {
        constexpr int kMinNumbers = 20;  // cells that hold a number
        return profiles_[column].numbers >= kMinNumbers && profiles_[column].changes == 0;
    }

    // Takes the only remaining column, other than y, that moves; else the named one that stands still, for the engine
    // to refuse.
    void take_moving_input(const std::vector<std::size_t>& free, const std::vector<std::size_t>& switching) {
        const NameFits named = fits(kInputRole);
        if (named.best.size() != 1) return;
        std::vector<std::size_t> moving;
        for (const std::size_t i : free)
            if (profiles_[i].changes > 0 && may_be(i, kInputRole)) moving.push_back(i);
        if (moving.size() + switching.size() == 1 && !moving.empty() &&
            !match(facts_.heading(moving.front()), kOutputRole))
            return take(kInputRole, moving.front(), " (the only other column that moves)");
        if (switching.size() != 1) take(kInputRole, named.best.front());
    }

    void refuse_equal_columns() {
        for (const ColumnRole role : kRoles) {
            if (!found_.at[role]) continue;
            for (const ColumnRole other : kRoles) {
                if (other < role && found_.at[role] == found_.at[other]) faults_.push_back(equal_columns(role, other));
            }
        }
    }

    ColumnFacts facts_;
    const CsvLayout& layout_;
    const std::vector<ColumnProfile>& profiles_;
    const CsvOptions& options_;
    std::vector<CsvFault>& faults_;
    std::array<std::optional<std::size_t>, kRoleCount> chosen_;
    std::vector<std::size_t> terms_;
    DetectedColumns found_;
};

}  // namespace

DetectedColumns find_columns(std::string_view text, const CsvLayout& layout, const std::vector<ColumnProfile>& profiles,
                             const CsvOptions& options, std::vector<CsvFault>& faults) {
    return ColumnFinder(text, layout, profiles, options, faults).find();
}

}  // namespace tunewright::api
