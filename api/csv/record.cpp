#include "api/csv/record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "api/csv/table.h"
#include "api/csv/time_stamp.h"
#include "api/describe/suggest.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMostFaults = 10;
constexpr std::size_t kShownLength = 40;

// In the order of preference.
constexpr std::array<std::string_view, 14> kTimeNames = {
    "t",          "time",    "timestamp", "date",    "datetime",     "date time", "date_time",
    "time stamp", "seconds", "sec",       "elapsed", "elapsed time", "zeit",      "zeitstempel"};
constexpr std::array<std::string_view, 21> kInputNames = {"u",
                                                          "op",
                                                          "mv",
                                                          "co",
                                                          "out",
                                                          "output",
                                                          "controller output",
                                                          "controlleroutput",
                                                          "manipulated variable",
                                                          "cv",
                                                          "input",
                                                          "valve",
                                                          "heater",
                                                          "power",
                                                          "stellgröße",
                                                          "y_out",
                                                          "control",
                                                          "u(t)",
                                                          "actuator",
                                                          "q",
                                                          "q1"};
constexpr std::array<std::string_view, 20> kOutputNames = {
    "y",        "pv",    "temp",     "temperature", "measurement", "process value", "process variable", "processvalue",
    "measured", "value", "mess",     "istwert",     "level",       "flow",          "pressure",         "speed",
    "sensor",   "y(t)",  "response", "t1"};

// "PV [degC]", "PV (degC)", "PV / degC" -> "pv" and "degC".
struct Heading {
    std::string name, unit;
};

Heading split_heading(std::string_view text) {
    text = trimmed(text);
    for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
        const std::size_t start = text.rfind(open);
        if (start != text.npos && start > 0 && text.back() == close) {
            return {lower_case(trimmed(text.substr(0, start))),
                    std::string(trimmed(text.substr(start + 1, text.size() - start - 2)))};
        }
    }
    if (const std::size_t slash = text.find(" / "); slash != text.npos && slash > 0) {
        return {lower_case(trimmed(text.substr(0, slash))), std::string(trimmed(text.substr(slash + 3)))};
    }
    // time_s, time_ms
    if (const std::size_t underscore = text.rfind('_');
        underscore != text.npos && underscore > 0 && seconds_per(text.substr(underscore + 1))) {
        const std::string stem = lower_case(text.substr(0, underscore));
        if (stem == "t" || stem == "time") return {stem, std::string(text.substr(underscore + 1))};
    }
    return {lower_case(text), {}};
}

// Running numbers that exports put in front.
bool is_index_heading(std::string_view heading) {
    const std::string name = lower_case(trimmed(heading));
    return name.empty() || name == "index" || name == "#" || name == "no" || name == "no." || name == "id" ||
           name.rfind("unnamed:", 0) == 0;
}

std::string quoted(std::string_view text) {
    std::string out(text.substr(0, kShownLength));
    while (!out.empty() && out.size() == kShownLength && (static_cast<unsigned char>(out.back()) & 0x80))
        out.pop_back();
    return "\"" + out + (out.size() < text.size() ? "...\"" : "\"");
}

std::string headings_listed(const CsvTable& table) {
    std::vector<std::string> names;
    for (const std::string& heading : table.headings) {
        if (!is_index_heading(heading)) names.push_back(quoted(heading));
    }
    return listed(names, "and");
}

struct Role {
    const char* name;  // "t", "u", "y"
    const char* meaning;
    std::span<const std::string_view> plain;
};

constexpr std::array<Role, 3> kRoles = {
    {{"t", "time", kTimeNames}, {"u", "the controller output", kInputNames}, {"y", "the measurement", kOutputNames}}};
constexpr std::size_t kTime = 0;

class RecordReader {
public:
    RecordReader(std::string_view text, const CsvOptions& options) : options_(options), table_(read_table(text)) {}

    std::variant<CsvRecord, std::vector<CsvFault>> read() {
        if (table_.lines.empty()) {
            fault("csv", table_.headings.empty()
                             ? "csv is empty; it needs a heading line such as t,u,y and lines of numbers."
                             : "csv has headings but no line of numbers.");
            return std::move(faults_);
        }
        find_columns();
        if (faults_.empty()) find_time_unit();
        if (faults_.empty()) read_lines();
        if (!faults_.empty()) return std::move(faults_);
        if (record_.t.empty()) {
            fault("csv", "csv has no complete sample: every line lacks t, u or y.");
            return std::move(faults_);
        }
        return std::move(record_);
    }

private:
    void fault(std::string where, std::string message) {
        if (faults_.size() < kMostFaults) faults_.push_back({std::move(where), std::move(message)});
    }

    std::size_t width() const {
        return table_.headings.empty() ? table_.lines.front().cells.size() : table_.headings.size();
    }

    std::optional<int> chosen(std::size_t role, const ColumnChoice& choice) {
        const std::string where = std::string("columns/") + kRoles[role].name;
        if (const int* number = std::get_if<int>(&choice)) {
            if (*number >= 1 && static_cast<std::size_t>(*number) <= width()) return *number - 1;
            fault(where, std::string(kRoles[role].name) + " is column " + std::to_string(*number) +
                             "; the csv has columns 1 to " + std::to_string(width()) + ".");
            return std::nullopt;
        }
        const std::string& name = std::get<std::string>(choice);
        if (table_.headings.empty()) {
            fault(where, std::string(kRoles[role].name) + " is " + quoted(name) +
                             ", but the first line of the csv has no headings; give column numbers from 1, or add a "
                             "heading line.");
            return std::nullopt;
        }
        for (std::size_t i = 0; i < table_.headings.size(); ++i) {
            if (table_.headings[i] == name) return static_cast<int>(i);
        }
        std::optional<int> found;
        const std::string wanted = lower_case(trimmed(name));
        for (std::size_t i = 0; i < table_.headings.size(); ++i) {
            if (lower_case(table_.headings[i]) != wanted && split_heading(table_.headings[i]).name != wanted) continue;
            if (found) {
                fault(where, std::string(kRoles[role].name) + " is " + quoted(name) +
                                 ", which fits several headings: " + headings_listed(table_) +
                                 ". Write the heading in full.");
                return std::nullopt;
            }
            found = static_cast<int>(i);
        }
        if (!found)
            fault(where, std::string(kRoles[role].name) + " is " + quoted(name) +
                             ", which is not a heading; the headings are " + headings_listed(table_) + ".");
        return found;
    }

    bool taken(std::size_t column) const {
        return std::find(column_.begin(), column_.end(), std::optional<int>(static_cast<int>(column))) != column_.end();
    }

    std::optional<int> found_by_name(std::size_t role) const {
        for (const std::string_view plain : kRoles[role].plain) {
            for (std::size_t i = 0; i < table_.headings.size(); ++i) {
                if (!taken(i) && split_heading(table_.headings[i]).name == plain) return static_cast<int>(i);
            }
        }
        return std::nullopt;
    }

    void find_columns() {
        const std::array<const std::optional<ColumnChoice>*, 3> choices = {&options_.columns.t, &options_.columns.u,
                                                                           &options_.columns.y};
        for (std::size_t role = 0; role < kRoles.size(); ++role) {
            if (*choices[role]) column_[role] = chosen(role, **choices[role]);
        }
        if (!faults_.empty()) return;
        for (std::size_t role = 0; role < kRoles.size(); ++role) {
            if (column_[role] || (role == kTime && options_.dt)) continue;
            column_[role] = found_by_name(role);
            if (column_[role]) note(role);
        }
        take_the_only_one_left();
        for (std::size_t role = 0; role < kRoles.size(); ++role) {
            if (!column_[role] && !(role == kTime && options_.dt)) report_missing(role);
        }
        for (std::size_t role = 1; role < kRoles.size(); ++role) {
            for (std::size_t other = 0; other < role; ++other) {
                if (column_[role] && column_[role] == column_[other]) {
                    fault(std::string("columns/") + kRoles[role].name, std::string(kRoles[role].name) + " and " +
                                                                           kRoles[other].name +
                                                                           " are the same column; choose another.");
                }
            }
        }
    }

    // With two columns named, a single further one that is no index must be the third.
    void take_the_only_one_left() {
        const auto missing =
            std::count(column_.begin(), column_.end(), std::nullopt) - (options_.dt && !column_[kTime] ? 1 : 0);
        if (missing != 1 || table_.headings.empty()) return;
        std::vector<int> free;
        for (std::size_t i = 0; i < table_.headings.size(); ++i) {
            if (!taken(i) && !is_index_heading(table_.headings[i])) free.push_back(static_cast<int>(i));
        }
        if (free.size() != 1) return;
        for (std::size_t role = 0; role < kRoles.size(); ++role) {
            if (column_[role] || (role == kTime && options_.dt)) continue;
            column_[role] = free.front();
            note(role);
        }
    }

    void note(std::size_t role) {
        record_.notes.push_back(std::string("Column ") +
                                quoted(table_.headings[static_cast<std::size_t>(*column_[role])]) + " is read as " +
                                kRoles[role].name + ", " + kRoles[role].meaning + ".");
    }

    void report_missing(std::size_t role) {
        const std::string name = kRoles[role].name;
        if (table_.headings.empty()) {
            fault("columns/" + name, "The csv has no headings, so " + name + " (" + kRoles[role].meaning +
                                         ") cannot be found; give its column number from 1 in columns." + name +
                                         (role == kTime ? ", or dt." : "."));
        } else {
            fault("columns/" + name, "No heading is plainly " + name + " (" + kRoles[role].meaning +
                                         "); name it in columns." + name + (role == kTime ? ", or give dt" : "") +
                                         ". The headings are " + headings_listed(table_) + ".");
        }
    }

    // What the time column counts, and the factor to the unit of the answer.
    void find_time_unit() {
        const auto answer = seconds_per(options_.time_unit);
        if (!column_[kTime]) return;
        const auto column = static_cast<std::size_t>(*column_[kTime]);
        const auto& cells = table_.lines.front().cells;
        double number = 0;
        stamps_ = column < cells.size() && !read_cell_number(cells[column], number) &&
                  read_time_stamp(cells[column]).has_value();
        if (stamps_) {
            if (!answer) {
                fault("csv", "The times are time stamps, and units.time is " + quoted(options_.time_unit) +
                                 "; it must be a unit that they can be converted to: ms, s, min, h or d.");
                return;
            }
            time_factor_ = 1 / *answer;
            return;
        }
        std::string unit;
        if (!table_.headings.empty()) unit = split_heading(table_.headings[column]).unit;
        if (unit.empty() && column < table_.units.cells.size()) unit = std::string(table_.units.cells[column]);
        const auto given = seconds_per(unit);
        if (!given || !answer || *given == *answer) return;
        time_factor_ = *given / *answer;
        record_.notes.push_back("Times are converted from " + unit + " to " + options_.time_unit +
                                (options_.time_unit_given ? "." : "; set units.time to keep them."));
    }

    void read_lines() {
        record_.t.reserve(table_.lines.size());
        record_.u.reserve(table_.lines.size());
        record_.y.reserve(table_.lines.size());
        std::size_t index = 0;
        for (const CsvTable::Line& line : table_.lines) {
            if (line.cells.size() > width()) return report_width(line);
            read_line(line, index++);
            if (faults_.size() == kMostFaults) return;
            if (record_.t.size() > options_.most_samples) {
                return fault("csv", "csv has more than " + std::to_string(options_.most_samples) +
                                        " samples; thin it out: a few thousand identify as well.");
            }
        }
    }

    void report_width(const CsvTable::Line& line) {
        fault("csv", "Line " + std::to_string(line.number) + " has " + std::to_string(line.cells.size()) +
                         " cells and the first line " + std::to_string(width()) +
                         ". Numbers with a decimal comma need ; or tab as separator, or quotes.");
    }

    void read_line(const CsvTable::Line& line, std::size_t index) {
        std::array<double, 3> value{};
        bool complete = true;
        for (std::size_t role = 0; role < kRoles.size(); ++role) {
            if (!column_[role]) {
                value[role] = static_cast<double>(index) * options_.dt.value_or(1);
                continue;
            }
            const auto column = static_cast<std::size_t>(*column_[role]);
            const std::string_view cell = column < line.cells.size() ? line.cells[column] : std::string_view();
            if (is_missing(cell)) {
                complete = false;
            } else if (!(role == kTime ? read_time(cell, value[role]) : read_cell_number(cell, value[role]))) {
                report_cell(line, role, cell);
                return;
            }
        }
        if (!complete) {
            ++record_.dropped;
            return;
        }
        record_.t.push_back(value[0]);
        record_.u.push_back(value[1]);
        record_.y.push_back(value[2]);
    }

    bool read_time(std::string_view cell, double& time) {
        if (!stamps_) {
            const bool good = read_cell_number(cell, time);
            time *= time_factor_;
            return good;
        }
        const auto stamp = read_time_stamp(cell);
        if (!stamp) return false;
        constexpr double kDay = 86400;
        double seconds = stamp->seconds + midnights_ * kDay;
        // A clock without a date that jumps back by more than half a day has passed midnight.
        if (!stamp->has_date && last_seconds_ && seconds < *last_seconds_ - kDay / 2) {
            midnights_ += 1;
            seconds += kDay;
        }
        last_seconds_ = seconds;
        if (!first_seconds_) first_seconds_ = seconds;
        time = (seconds - *first_seconds_) * time_factor_;
        return true;
    }

    void report_cell(const CsvTable::Line& line, std::size_t role, std::string_view cell) {
        const std::string column = table_.headings.empty()
                                       ? kRoles[role].name
                                       : quoted(table_.headings[static_cast<std::size_t>(*column_[role])]);
        fault("csv", "Line " + std::to_string(line.number) + ", column " + column + ": " + quoted(cell) + " is not " +
                         (role == kTime && stamps_ ? "a time stamp like the first." : "a number.") +
                         " Mend the line, or leave the cell blank to drop it.");
    }

    const CsvOptions& options_;
    CsvTable table_;
    std::array<std::optional<int>, 3> column_;
    bool stamps_ = false;
    double time_factor_ = 1;
    double midnights_ = 0;
    std::optional<double> first_seconds_, last_seconds_;
    CsvRecord record_;
    std::vector<CsvFault> faults_;
};

}  // namespace

std::variant<CsvRecord, std::vector<CsvFault>> read_csv_record(std::string_view text, const CsvOptions& options) {
    return RecordReader(text, options).read();
}

}  // namespace tunewright::api
