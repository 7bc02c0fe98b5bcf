#include "api/csv/columns/column_facts.h"

#include "api/csv/time_stamp.h"
#include "api/describe/suggest.h"

namespace tunewright::api {

ColumnFacts::ColumnFacts(std::string_view text, const CsvLayout& layout, const std::vector<ColumnProfile>& profiles)
    : text_(text), layout_(layout), profiles_(profiles) {
    for (const std::string& heading : layout.headings) headings_.push_back(split_heading(heading));
    headings_.resize(profiles.size());
}

bool ColumnFacts::holds_numbers(std::size_t column) const {
    const ColumnProfile& p = profiles_[column];
    return p.numbers > 0 && p.numbers >= p.texts + p.stamps;
}

bool ColumnFacts::switches(std::size_t column) const {
    const ColumnProfile& p = profiles_[column];
    const int others = p.texts + p.stamps;
    return p.switches > 0 && kDamagedShare * others <= p.switches;
}

bool ColumnFacts::is_index(std::size_t column) const {
    return !layout_.headings.empty() &&
           (column >= layout_.headings.size() || tunewright::api::is_index(layout_.headings[column]));
}

bool ColumnFacts::mostly_one_way(std::size_t column) const {
    const ColumnProfile& p = profiles_[column];
    constexpr int kMinRowsPerFall = 10;
    return kMinRowsPerFall * p.falls <= p.numbers || kMinRowsPerFall * (p.changes - p.falls) <= p.numbers;
}

// A column that rises and falls holds no times; a capital T that rises unevenly is more likely a temperature.
bool ColumnFacts::may_be_time(std::size_t column) const {
    const Heading& heading = headings_[column];
    const ColumnProfile& p = profiles_[column];
    constexpr int kMinRows = 3;
    if (p.stamps == 0 && !holds_numbers(column)) return false;
    if (is_spacing(heading) && p.changes == 0 && p.numbers != 2) return false;
    // "S:40" of a serial log is more likely a set point than seconds.
    if (heading.name == "s" && p.numbers >= kMinRows && !p.rises) return false;
    if (heading.name != "t" || p.stamps > 0) return true;
    if (!heading.unit.empty()) return seconds_per(heading.unit).has_value();
    if (p.numbers < kMinRows) return true;
    if (4 * p.falls > p.numbers && 4 * p.falls < 3 * p.numbers) return false;
    if (heading.text.front() != 'T') return true;
    return p.rises && p.largest_step < 2 * p.min_step;
}

bool ColumnFacts::is_clock(std::size_t column) const {
    const ColumnProfile& p = profiles_[column];
    return (p.stamps > 0 && p.numbers == 0 && p.texts == 0) ||
           (p.numbers > 2 && p.rises && match(headings_[column], kTimeRole));
}

bool ColumnFacts::held(std::size_t a, std::size_t b) const {
    const ColumnProfile &p = profiles_[a], &q = profiles_[b];
    return p.numbers > 3 && 2 * p.changes < p.numbers && 4 * p.changes < q.changes;
}

std::string ColumnFacts::shown(std::size_t column) const {
    return column < layout_.headings.size() && !layout_.headings[column].empty() ? in_quotes(layout_.headings[column])
                                                                                 : std::to_string(column + 1);
}

std::string ColumnFacts::shown(const std::vector<std::size_t>& columns) const {
    std::vector<std::string> names;
    names.reserve(columns.size());
    for (const std::size_t i : columns) names.push_back(shown(i));
    return listed(names, "and");
}

std::string ColumnFacts::headings_listed() const {
    std::vector<std::string> names;
    for (const std::string& heading : layout_.headings) {
        if (!tunewright::api::is_index(heading)) names.push_back(in_quotes(heading));
    }
    return listed(names, "and");
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t kShownLength = 40;
    std::string out(text.substr(0, kShownLength));
    if (out.size() < text.size()) {
        while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xC0) == 0x80) out.pop_back();
        if (!out.empty() && (static_cast<unsigned char>(out.back()) & 0x80)) out.pop_back();
        out += "...";
    }
    return "\"" + out + "\"";
}

}  // namespace tunewright::api
