#include "api/csv/columns.h"

#include <algorithm>

#include "api/csv/time_stamp.h"
#include "api/describe/suggest.h"

namespace tunewright::api {
namespace {

constexpr int kProfiledLines = 5000;

struct RoleText {
    const char* name;
    const char* meaning;
};
constexpr std::array<RoleText, kRoleCount> kRoles = {
    {{"t", "time"}, {"u", "the controller output"}, {"y", "the measurement"}}};

void look_at(std::string_view cell, DecimalSign sign, double& last, ColumnProfile& profile) {
    if (is_missing(cell)) {
        ++profile.missing;
        return;
    }
    double value = 0;
    if (profile.numbers == 0) profile.suffix = std::string(unit_suffix(cell));
    if (read_cell_number(cell, value, sign, profile.suffix)) {
        if (profile.numbers > 0) {
            profile.changes += value != last ? 1 : 0;
            profile.rises = profile.rises && value > last;
        }
        last = value;
        ++profile.numbers;
    } else if (const auto stamp = read_time_stamp(cell)) {
        ++profile.stamps;
        profile.dates += stamp->has_clock ? 0 : 1;
        profile.clocks += stamp->has_date ? 0 : 1;
    } else {
        if (profile.texts++ == 0) profile.first_text = std::string(cell);
    }
}

class ColumnFinder {
public:
    ColumnFinder(const CsvLayout& layout, const std::vector<ColumnProfile>& profiles, const CsvOptions& options,
                 std::vector<CsvFault>& faults)
        : layout_(layout), profiles_(profiles), options_(options), faults_(faults) {
        for (const std::string& heading : layout.headings) headings_.push_back(split_heading(heading));
        headings_.resize(profiles.size());
    }

    FoundColumns find() {
        const std::array<const std::optional<ColumnChoice>*, kRoleCount> choices = {
            &options_.columns.t, &options_.columns.u, &options_.columns.y};
        for (std::size_t role = 0; role < kRoleCount; ++role) {
            if (*choices[role]) found_.at[role] = chosen(role, **choices[role]);
        }
        if (!faults_.empty()) return found_;
        if (refuse_one_line_a_tag()) return found_;
        for (std::size_t role = 0; role < kRoleCount; ++role) {
            if (wanted(role)) by_name(static_cast<Role>(role));
        }
        if (!faults_.empty()) return found_;
        join_date_and_clock();
        if (wanted(kTimeRole)) time_by_content();
        rest_by_content();
        for (std::size_t role = 0; role < kRoleCount; ++role) {
            if (wanted(role)) report_missing(role);
        }
        refuse_equal_columns();
        return found_;
    }

private:
    bool wanted(std::size_t role) const { return !found_.at[role] && !(role == kTimeRole && options_.dt); }

    void fault(std::size_t role, std::string message) {
        faults_.push_back({std::string("columns/") + kRoles[role].name, std::move(message)});
    }

    std::string headings_listed() const {
        std::vector<std::string> names;
        for (const std::string& heading : layout_.headings) {
            if (!is_index(heading)) names.push_back(quoted(heading));
        }
        return listed(names, "and");
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
            if (lower_case(layout_.headings[i]) != wanted && headings_[i].name != wanted) continue;
            if (found) {
                fault(role, name + " is " + quoted(text) + ", which fits several headings: " + headings_listed() +
                                ". Write the heading in full.");
                return std::nullopt;
            }
            found = i;
        }
        if (!found)
            fault(role, name + " is " + quoted(text) + ", which is not a heading; the headings are " +
                            headings_listed() + ".");
        return found;
    }

    bool taken(std::size_t column) const {
        return found_.clock == column || std::find(found_.at.begin(), found_.at.end(), column) != found_.at.end();
    }

    bool holds_numbers(std::size_t column) const {
        const ColumnProfile& p = profiles_[column];
        return p.numbers > 0 && p.numbers >= p.texts + p.stamps;
    }

    bool may_be(std::size_t column, Role role) const {
        if (taken(column)) return false;
        const ColumnProfile& p = profiles_[column];
        if (role == kTimeRole) return p.stamps > 0 || holds_numbers(column);
        return !is_beside_the_point(headings_[column]) && p.numbers + p.missing > 0 && p.stamps == 0 &&
               (p.texts == 0 || holds_numbers(column));
    }

    void take(std::size_t role, std::size_t column, const std::string& why = "") {
        found_.at[role] = column;
        if (why.empty() && headings_[column].name == kRoles[role].name) return;
        found_.notes.push_back("Column " + shown(column) + " is read as " + kRoles[role].name + ", " +
                               kRoles[role].meaning + why + ".");
    }

    std::string shown(std::size_t column) const {
        return column < layout_.headings.size() && !layout_.headings[column].empty() ? quoted(layout_.headings[column])
                                                                                     : std::to_string(column + 1);
    }

    // The plainest name wins; several tags that end alike are not guessed among.
    void by_name(Role role) {
        std::optional<NameMatch> best;
        std::vector<std::size_t> fits;
        for (std::size_t i = 0; i < layout_.headings.size(); ++i) {
            if (!may_be(i, role)) continue;
            const auto now = match(headings_[i], role);
            if (!now) continue;
            const bool better = !best || now->level < best->level ||
                                (now->level == best->level && now->level == 1 && now->order < best->order);
            if (better) {
                best = now;
                fits = {i};
            } else if (now->level == best->level && now->level > 1) {
                fits.push_back(i);
            }
        }
        if (fits.size() == 1 || (role == kTimeRole && !fits.empty())) return take(role, fits.front());
        if (fits.empty()) return by_very_name(role);
        std::vector<std::string> names;
        for (const std::size_t i : fits) names.push_back(shown(i));
        fault(role, "Several columns may be " + std::string(kRoles[role].name) + " (" + kRoles[role].meaning +
                        "): " + listed(names, "and") + ". Name one in columns." + kRoles[role].name + ".");
    }

    // A column of the very name that holds no number: reading it tells which line is wrong.
    void by_very_name(Role role) {
        for (std::size_t i = 0; i < layout_.headings.size(); ++i) {
            const auto now = taken(i) ? std::nullopt : match(headings_[i], role);
            if (now && now->level == 1) return take(role, i);
        }
    }

    // Historians also export one line for each tag and time.
    bool refuse_one_line_a_tag() {
        bool tag = false, value = false;
        for (std::size_t i = 0; i < layout_.headings.size(); ++i) {
            const std::string& name = headings_[i].name;
            const bool texts = profiles_[i].texts > 0 && !holds_numbers(i);
            tag = tag || (texts && (name == "tagname" || name == "tag" || name == "varname" || name == "pointname" ||
                                    name == "name" || name == "tag name" || name == "variable"));
            value = value || name == "value" || name == "varvalue" || name == "wert" || name == "vvalue";
        }
        if (!tag || !value || options_.columns.u || options_.columns.y) return false;
        faults_.push_back({"csv", "csv has one line for each tag and time (columns " + headings_listed() +
                                      "); export it with one column for each tag, so that u and y stand in one line."});
        return true;
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
            const bool index =
                !layout_.headings.empty() && (i >= layout_.headings.size() || is_index(layout_.headings[i]));
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
        std::vector<std::size_t> roles, free;
        for (const std::size_t role : {std::size_t{kTimeRole}, std::size_t{kInputRole}, std::size_t{kOutputRole}}) {
            if (wanted(role)) roles.push_back(role);
        }
        for (std::size_t i = 0; i < profiles_.size(); ++i) {
            const bool index =
                !layout_.headings.empty() && (i >= layout_.headings.size() || is_index(layout_.headings[i]));
            if (!index && may_be(i, kOutputRole)) free.push_back(i);
        }
        if (roles.size() == 1 && free.size() == 1 && (!layout_.headings.empty() || roles.front() != kTimeRole))
            return take(roles.front(), free.front());
        if (roles.size() != 2 || free.size() != 2 || roles.front() == kTimeRole) return;
        // u stays on its levels, y moves.
        const auto held = [&](std::size_t a, std::size_t b) {
            const ColumnProfile &p = profiles_[a], &q = profiles_[b];
            return p.numbers > 3 && 2 * p.changes < p.numbers && 4 * p.changes < q.changes;
        };
        for (const auto& [u, y] : {std::pair{free[0], free[1]}, std::pair{free[1], free[0]}}) {
            if (!held(u, y)) continue;
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
                            headings_listed() + ".");
        }
    }

    void refuse_equal_columns() {
        for (std::size_t role = 1; role < kRoleCount; ++role) {
            for (std::size_t other = 0; other < role; ++other) {
                if (found_.at[role] && found_.at[role] == found_.at[other])
                    fault(role, std::string(kRoles[role].name) + " and " + kRoles[other].name +
                                    " are the same column; choose another.");
            }
        }
    }

    const CsvLayout& layout_;
    const std::vector<ColumnProfile>& profiles_;
    const CsvOptions& options_;
    std::vector<CsvFault>& faults_;
    std::vector<Heading> headings_;
    FoundColumns found_;
};

}  // namespace

std::vector<ColumnProfile> profiles(std::string_view text, const CsvLayout& layout) {
    std::vector<ColumnProfile> out(layout.width);
    std::vector<double> last(layout.width, 0);
    CsvLines lines(text, layout);
    CsvLine line;
    for (int n = 0; n < kProfiledLines && lines.next(line); ++n) {
        for (std::size_t i = 0; i < out.size(); ++i)
            look_at(i < line.cells.size() ? line.cells[i] : std::string_view(), layout.sign, last[i], out[i]);
    }
    return out;
}

FoundColumns find_columns(const CsvLayout& layout, const std::vector<ColumnProfile>& profiles,
                          const CsvOptions& options, std::vector<CsvFault>& faults) {
    return ColumnFinder(layout, profiles, options, faults).find();
}

std::string quoted(std::string_view text) {
    constexpr std::size_t kShownLength = 40;
    std::string out(text.substr(0, kShownLength));
    if (out.size() < text.size()) {
        while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xC0) == 0x80) out.pop_back();
        if (!out.empty() && (static_cast<unsigned char>(out.back()) & 0x80)) out.pop_back();
        out += "...";
    }
    return "\"" + out + "\"";
}

const char* role_name(std::size_t role) { return kRoles[role].name; }

}  // namespace tunewright::api
