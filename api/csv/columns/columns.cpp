#include "api/csv/columns/columns.h"

#include <algorithm>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/column_pairs.h"
#include "api/csv/columns/column_refusals.h"

namespace tunewright::api {
namespace {

struct RoleText {
    const char* name;
    const char* meaning;
};
constexpr std::array<RoleText, kRoleCount> kRoles = {
    {{"t", "time"}, {"u", "the controller output"}, {"y", "the measurement"}, {"r", "the set point"}}};
/// Those without which there is no record.
constexpr std::size_t kNeededRoles = kReferenceRole;

class ColumnFinder {
public:
    ColumnFinder(std::string_view text, const CsvLayout& layout, const std::vector<ColumnProfile>& profiles,
                 const CsvOptions& options, std::vector<CsvFault>& faults)
        : facts_(text, layout, profiles), layout_(layout), profiles_(profiles), options_(options), faults_(faults) {}

    FoundColumns find() {
        const std::array<const std::optional<ColumnChoice>*, kRoleCount> choices = {
            &options_.columns.t, &options_.columns.u, &options_.columns.y, &options_.columns.r};
        for (std::size_t role = 0; role < kRoleCount; ++role) {
            if (*choices[role]) found_.at[role] = chosen(role, **choices[role]);
        }
        if (!faults_.empty()) return found_;
        chosen_ = found_.at;
        if (!chosen_[kInputRole] && !chosen_[kOutputRole]) {
            if (auto fault = one_line_a_tag(facts_)) faults_.push_back(*std::move(fault));
        }
        find_terms();
        if (const auto letters = german_letters(facts_)) take_pair(*letters);
        find_spacing();
        if (wanted(kTimeRole)) take_fitting(kTimeRole, fits(kTimeRole));
        read_input_beside_output();
        if (!faults_.empty()) return found_;
        read_input_and_output();
        if (!faults_.empty()) return found_;
        join_date_and_clock();
        if (wanted(kTimeRole)) time_by_content();
        rest_by_content();
        find_reference();
        for (std::size_t role = 0; role < kNeededRoles; ++role) {
            if (wanted(role)) report_missing(role);
        }
        refuse_equal_columns();
        if (faults_.empty()) check_clocks();
        check_surplus();
        return found_;
    }

private:
    bool wanted(std::size_t role) const {
        return !found_.at[role] && !(role == kTimeRole && (options_.dt || found_.spacing));
    }

    void fault(std::size_t role, std::string message) {
        faults_.push_back({std::string("columns/") + kRoles[role].name, std::move(message)});
    }

    std::optional<std::size_t> chosen(std::size_t role, const ColumnChoice& choice) {
        const std::string name = kRoles[role].name;
        if (const int* number = std::get_if<int>(&choice)) {
            if (*number >= 1 && static_cast<std::size_t>(*number) <= profiles_.size())
                return static_cast<std::size_t>(*number) - 1;
            fault(role, name + " is column " + std::to_string(*number) + "; the csv has columns 1 to " +
                            std::to_string(profiles_.size()) + ".");
            return std::nullopt;
        }
        const std::string& text = std::get<std::string>(choice);
        if (layout_.headings.empty()) {
            fault(role, name + " is " + quoted(text) +
                            ", but the first line of the csv has no headings; give column numbers from 1, or add a "
                            "heading line.");
            return std::nullopt;
        }
        const auto exact = std::find(layout_.headings.begin(), layout_.headings.end(), text);
        if (exact != layout_.headings.end()) return static_cast<std::size_t>(exact - layout_.headings.begin());
        return chosen_loosely(role, text);
    }

    std::optional<std::size_t> chosen_loosely(std::size_t role, const std::string& text) {
        std::optional<std::size_t> found;
        const std::string name = kRoles[role].name, wanted = lower_case(trimmed(text));
        for (std::size_t i = 0; i < layout_.headings.size(); ++i) {
            if (lower_case(layout_.headings[i]) != wanted && facts_.heading(i).name != wanted) continue;
            if (found) {
                fault(role, name + " is " + quoted(text) + ", which fits several headings: " +
                                facts_.headings_listed() + ". Write the heading in full.");
                return std::nullopt;
            }
            found = i;
        }
        if (!found)
            fault(role, name + " is " + quoted(text) + ", which is not a heading; the headings are " +
                            facts_.headings_listed() + ".");
        return found;
    }

    bool taken(std::size_t column) const {
        return found_.clock == column || std::find(found_.at.begin(), found_.at.end(), column) != found_.at.end();
    }

    bool is_term(std::size_t column) const { return std::find(terms_.begin(), terms_.end(), column) != terms_.end(); }

    bool may_be(std::size_t column, Role role) const {
        if (taken(column) || found_.spacing == column) return false;
        const ColumnProfile& p = profiles_[column];
        if (role == kTimeRole) return facts_.may_be_time(column);
        const bool numeric = p.numbers + p.missing > 0 && p.stamps == 0 && p.switches == 0 &&
                             (p.texts == 0 || facts_.holds_numbers(column));
        if (role == kReferenceRole) return numeric && p.numbers > 0 && !is_term(column);
        if (is_term(column)) return false;
        if (role == kInputRole && facts_.switches(column))
            return !match(facts_.heading(column), kReferenceRole) &&
                   (!is_auxiliary(facts_.heading(column)) || is_state(facts_.heading(column)));
        return numeric && !is_auxiliary(facts_.heading(column));
    }

    void take(std::size_t role, std::size_t column, const std::string& why = "") {
        found_.at[role] = column;
        if (why.empty() && facts_.heading(column).name == kRoles[role].name) return;
        found_.notes.push_back("Column " + facts_.shown(column) + " is read as " + kRoles[role].name + ", " +
                               kRoles[role].meaning + why + ".");
    }

    struct Fits {
        std::vector<std::size_t> best;    ///< as plain as each other
        std::vector<std::size_t> others;  ///< of the very name too, but less plain
    };

    // The plainest name wins; several tags that end alike are not guessed among.
    Fits fits(Role role) const {
        std::optional<NameMatch> best;
        Fits fits;
        for (std::size_t i = 0; i < layout_.headings.size(); ++i) {
            if (!may_be(i, role)) continue;
            const auto now = match(facts_.heading(i), role);
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

    void take_fitting(Role role, const Fits& fits) {
        if (fits.best.size() == 1 || (role == kTimeRole && !fits.best.empty())) {
            take(role, fits.best.front(), rivals(role, fits));
            return;
        }
        if (fits.best.empty()) return by_very_name(role);
        fault(role, "Several columns may be " + std::string(kRoles[role].name) + " (" + kRoles[role].meaning +
                        "): " + facts_.shown(fits.best) + ". Name one in columns." + kRoles[role].name + ".");
    }

    // What else might have been meant.
    std::string rivals(Role role, const Fits& fits) const {
        if (role == kTimeRole || fits.others.empty()) return "";
        std::vector<std::size_t> moving;
        for (const std::size_t i : fits.others) {
            if (profiles_[i].changes > 0) moving.push_back(i);
        }
        if (moving.empty()) return "";
        const std::string why = role == kOutputRole && is_measured(facts_.heading(fits.best.front()))
                                    ? ", as the measured one; it may also be "
                                    : "; it may also be ";
        return why + facts_.shown(moving) + ", which columns." + kRoles[role].name + " chooses";
    }

    void read_input_and_output() {
        Fits u = wanted(kInputRole) ? fits(kInputRole) : Fits{}, y = wanted(kOutputRole) ? fits(kOutputRole) : Fits{};
        keep_partners(u, y);
        if (wanted(kInputRole) && wanted(kOutputRole) && u.best.empty() && y.best.empty() && take_data_set()) return;
        if (wanted(kInputRole)) take_fitting(kInputRole, u);
        if (wanted(kOutputRole)) take_fitting(kOutputRole, y);
        if (wanted(kInputRole) && faults_.empty()) take_command();
        refuse_strangers();
    }

    // Of what names alone leave open: what moves, and what belongs together by its names. Tags of a table belong
    // together where one of them was chosen; "heater_bed.temp" of a log, and "Temperature 1", anyway.
    void keep_partners(Fits& u, Fits& y) {
        keep_moving(u);
        keep_moving(y);
        const bool chosen = chosen_[kInputRole] || chosen_[kOutputRole];
        const auto known = [&](Role role, const Fits& fits) {
            return chosen_[role]           ? chosen_[role]
                   : fits.best.size() == 1 ? std::optional(fits.best.front())
                                           : std::nullopt;
        };
        for (const auto same : {stem, number_behind}) {
            if (same == stem && !layout_.pairs && !chosen) continue;
            if (const auto column = known(kInputRole, u)) keep_beside(*column, same, y);
            if (const auto column = known(kOutputRole, y)) keep_beside(*column, same, u);
        }
    }

    void keep_beside(std::size_t column, std::string (*same)(const Heading&), Fits& fits) const {
        const std::string own = same(facts_.heading(column));
        std::vector<std::size_t> kept, rest;
        for (const std::size_t i : fits.best) (same(facts_.heading(i)) == own ? kept : rest).push_back(i);
        if (own.empty() || kept.size() != 1 || rest.empty()) return;
        fits.best = std::move(kept);
        fits.others.insert(fits.others.end(), rest.begin(), rest.end());
    }

    // What stands still is neither what was driven nor what answered.
    void keep_moving(Fits& fits) {
        if (fits.best.size() < 2) return;
        std::vector<std::size_t> moving, rest;
        int lines = 0;
        for (const std::size_t i : fits.best) {
            (profiles_[i].changes > 0 ? moving : rest).push_back(i);
            lines = std::max(lines, profiles_[i].numbers);
        }
        if (moving.empty() || rest.empty()) return;
        const std::string until = lines < kProfiledLines ? "" : " in the first " + std::to_string(lines) + " lines";
        found_.notes.push_back(facts_.shown(rest) + (rest.size() == 1 ? " does" : " do") + " not move" + until +
                               " and " + (rest.size() == 1 ? "was" : "were") + " passed over.");
        fits.best = std::move(moving);
    }

    // In a log of several heaters the one's temperature does not answer the other's power.
    void refuse_strangers() {
        if (!layout_.pairs || !found_.at[kInputRole] || !found_.at[kOutputRole]) return;
        if (chosen_[kInputRole] || chosen_[kOutputRole]) return;
        const std::string u = stem(facts_.heading(*found_.at[kInputRole])),
                          y = stem(facts_.heading(*found_.at[kOutputRole]));
        if (u.empty() || y.empty() || u == y) return;
        fault(kOutputRole, facts_.shown(*found_.at[kInputRole]) + " and " + facts_.shown(*found_.at[kOutputRole]) +
                               " do not belong together by their names. Name u in columns.u and y in columns.y.");
    }

    bool take_data_set() {
        const auto pair = data_set(facts_);
        if (pair) take_pair(*pair);
        return pair.has_value();
    }

    void read_input_beside_output() {
        const auto found = input_beside_output(facts_, [&](std::size_t column) { return may_be(column, kInputRole); });
        if (!wanted(kInputRole) || !wanted(kOutputRole)) return;
        if (const auto* pair = std::get_if<NamedPair>(&found)) take_pair(*pair);
        if (const auto* sentence = std::get_if<std::string>(&found)) fault(kInputRole, *sentence);
    }

    void take_pair(const NamedPair& pair) {
        if (!wanted(kInputRole) || !wanted(kOutputRole)) return;
        take(kInputRole, pair.u, pair.why_u);
        take(kOutputRole, pair.y, pair.why_y);
        if (!pair.note.empty()) found_.notes.push_back(pair.note);
    }

    void check_clocks() {
        if (!found_.at[kTimeRole]) return;
        for (const Role role : {kInputRole, kOutputRole}) {
            if (found_.clock && *found_.clock + 1 == *found_.at[role]) continue;
            if (auto fault = two_clocks(facts_, *found_.at[kTimeRole], *found_.at[role]))
                return faults_.push_back(*std::move(fault));
        }
    }

    // More headings than values: the first ones are believed where time, u and y are among them by name.
    void check_surplus() {
        if (layout_.surplus.empty()) return;
        bool plain = faults_.empty();
        for (const Role role : {kTimeRole, kInputRole, kOutputRole}) {
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
                               "; they are passed over.");
    }

    // "Ts" with one number, or always the same one.
    void find_spacing() {
        if (!wanted(kTimeRole)) return;
        for (std::size_t i = 0; i < facts_.size(); ++i) {
            const ColumnProfile& p = profiles_[i];
            const bool constant = p.numbers != 2 && p.changes == 0;
            if (taken(i) || !is_spacing(facts_.heading(i)) || !constant || !(p.first > 0) || p.texts > 0) continue;
            for (std::size_t k = 0; k < facts_.size(); ++k) {
                if (k != i && may_be(k, kTimeRole) && match(facts_.heading(k), kTimeRole)) return;
            }
            found_.spacing = i;
            return;
        }
    }

    // The set point is told where it is in the file; nothing depends on it that could be refused.
    void find_reference() {
        if (found_.at[kReferenceRole]) return;
        Fits r = fits(kReferenceRole);
        if (r.best.empty()) {
            for (std::size_t i = 0; i < facts_.size(); ++i) {
                if (is_command(facts_.heading(i)) && may_be(i, kReferenceRole)) r.best.push_back(i);
            }
        }
        for (const Role role : {kOutputRole, kInputRole}) {
            for (const auto same : {stem, number_behind}) {
                if (found_.at[role]) keep_beside(*found_.at[role], same, r);
            }
        }
        if (r.best.size() == 1) return take(kReferenceRole, r.best.front());
        if (r.best.empty()) return;
        found_.notes.push_back("Several columns may be the set point: " + facts_.shown(r.best) +
                               "; none is read. Name one in columns.r.");
    }

    // "cmd" is what was sent to the plant, where nothing else is.
    void take_command() {
        std::vector<std::size_t> commands;
        for (std::size_t i = 0; i < facts_.size(); ++i) {
            if (is_command(facts_.heading(i)) && may_be(i, kReferenceRole)) commands.push_back(i);
        }
        if (commands.size() == 1)
            take(kInputRole, commands.front(), " (no other column is; it may be the set point of an inner loop)");
    }

    // A column of the very name that holds no number: reading it tells which line is wrong.
    void by_very_name(Role role) {
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
            found_.notes.push_back("Date and time of day are joined from two columns.");
            return;
        }
    }

    void time_by_content() {
        std::vector<std::size_t> stamps, rising;
        for (std::size_t i = 0; i < profiles_.size(); ++i) {
            if (taken(i)) continue;
            const ColumnProfile& p = profiles_[i];
            const bool index = facts_.is_index(i);
            if (p.stamps > 0 && p.numbers == 0 && p.texts == 0) stamps.push_back(i);
            if (p.numbers > 2 && p.rises && p.stamps == 0 && p.texts == 0 && !index) rising.push_back(i);
        }
        if (!stamps.empty()) {
            take(kTimeRole, stamps.front(), " (it holds time stamps)");
            return join_date_and_clock();
        }
        // In a file with headings, u and y may rise too; the first column is where time stands.
        if (!rising.empty() && (rising.size() == 1 || rising.front() == 0))
            take(kTimeRole, rising.front(), " (its numbers rise from line to line)");
    }

    void rest_by_content() {
        std::vector<std::size_t> roles, free, switching;
        for (const std::size_t role : {std::size_t{kTimeRole}, std::size_t{kInputRole}, std::size_t{kOutputRole}}) {
            if (wanted(role)) roles.push_back(role);
        }
        for (std::size_t i = 0; i < profiles_.size(); ++i) {
            if (facts_.is_index(i)) continue;
            if (may_be(i, kOutputRole) && profiles_[i].numbers > 0 && !is_spacing(facts_.heading(i))) free.push_back(i);
            if (facts_.switches(i) && may_be(i, kInputRole)) switching.push_back(i);
        }
        if (wanted(kInputRole) && switching.size() == 1) {
            take(kInputRole, switching.front(), " (it switches)");
            std::erase(roles, std::size_t{kInputRole});
        }
        if (roles.size() == 1 && free.size() == 1 &&
            (roles.front() != kTimeRole || (!layout_.headings.empty() && facts_.mostly_one_way(free.front()))))
            return take(roles.front(), free.front(), " (the only column left)");
        if (roles.size() != 2 || free.size() != 2 || roles.front() == kTimeRole) return;
        for (const auto& [u, y] : {std::pair{free[0], free[1]}, std::pair{free[1], free[0]}}) {
            if (!facts_.held(u, y)) continue;
            take(kInputRole, u, " (it stays on its levels)");
            take(kOutputRole, y, " (it moves)");
            return;
        }
    }

    void report_missing(std::size_t role) {
        const std::string name = kRoles[role].name;
        if (layout_.headings.empty()) {
            fault(role, "The csv has no headings, so " + name + " (" + kRoles[role].meaning +
                            ") cannot be found; give its column number from 1 in columns." + name +
                            (role == kTimeRole ? ", or dt." : "."));
        } else {
            fault(role, "No heading is plainly " + name + " (" + kRoles[role].meaning + "); name it in columns." +
                            name + (role == kTimeRole ? ", or give dt" : "") + ". The headings are " +
                            facts_.headings_listed() + ".");
        }
    }

    void refuse_equal_columns() {
        for (std::size_t role = 1; role < kRoleCount; ++role) {
            if (!found_.at[role]) continue;
            for (std::size_t other = 0; other < role; ++other) {
                if (found_.at[role] && found_.at[role] == found_.at[other])
                    fault(role, std::string(kRoles[role].name) + " and " + kRoles[other].name +
                                    " are the same column; choose another.");
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
    FoundColumns found_;
};

}  // namespace

FoundColumns find_columns(std::string_view text, const CsvLayout& layout, const std::vector<ColumnProfile>& profiles,
                          const CsvOptions& options, std::vector<CsvFault>& faults) {
    return ColumnFinder(text, layout, profiles, options, faults).find();
}

const char* role_name(std::size_t role) { return kRoles[role].name; }

}  // namespace tunewright::api
