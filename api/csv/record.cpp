#include "api/csv/record.h"

#include <cmath>
#include <limits>

#include "api/csv/columns.h"
#include "api/csv/encoding.h"
#include "api/csv/time_column.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMostFaults = 10;
constexpr double kLargest = 1e30;  // as in every number of the contract

class RecordReader {
public:
    RecordReader(std::string_view text, const CsvOptions& options)
        : text_(text), options_(options), layout_(find_layout(text)) {}

    std::variant<CsvRecord, std::vector<CsvFault>> read() {
        check_layout();
        if (faults_.empty()) {
            profiles_ = profiles(text_, layout_);
            columns_ = find_columns(layout_, profiles_, options_, faults_);
        }
        if (faults_.empty()) read_lines();
        if (faults_.empty() && record_.t.empty())
            fault("csv", "csv has no complete sample: every line lacks t, u or y.");
        if (!faults_.empty()) return std::move(faults_);
        return std::move(record_);
    }

private:
    void fault(std::string where, std::string message) {
        if (faults_.size() < kMostFaults) faults_.push_back({std::move(where), std::move(message)});
    }

    void check_layout() {
        if (layout_.data_line == 0) {
            fault("csv", layout_.lines_of_text == 0
                             ? "csv is empty; it needs a heading line such as t,u,y and lines of numbers."
                             : "csv has headings but no line of numbers.");
        } else if (layout_.headings.empty() && layout_.narrow_heading_line > 0) {
            fault("csv", "Line " + std::to_string(layout_.narrow_heading_line) + " has " +
                             std::to_string(layout_.narrow_heading_cells) + " headings and line " +
                             std::to_string(layout_.data_line) + " has " + std::to_string(layout_.width) +
                             " cells. Numbers with a decimal comma need ; or tab as separator, or quotes.");
        }
    }

    void read_lines() {
        std::optional<TimeColumn> times;
        if (columns_.at[kTimeRole])
            times.emplace(text_, layout_, columns_, profiles_[*columns_.at[kTimeRole]], options_, faults_);
        if (!faults_.empty()) return;
        reserve();
        CsvLines lines(text_, layout_);
        CsvLine line;
        while (lines.next(line)) {
            if (line.cells.size() > layout_.width && !only_blanks_beyond(line))
                report_width(line);
            else
                read_line(line, times);
            ++index_;
            if (faults_.size() >= kMostFaults) return;
            if (record_.t.size() > options_.most_samples) {
                return fault("csv", "csv has more than " + std::to_string(options_.most_samples) +
                                        " samples; thin it out: a few thousand identify as well.");
            }
        }
        write_notes(times);
    }

    void reserve() {
        constexpr std::size_t kShortestLine = 6;
        const std::size_t typical = layout_.width * 4 + kShortestLine;
        const std::size_t most = std::min(options_.most_samples, text_.size() / typical + 1);
        for (auto* column : {&record_.t, &record_.u, &record_.y}) column->reserve(most);
        record_.lines.reserve(most);
    }

    bool only_blanks_beyond(const CsvLine& line) const {
        for (std::size_t i = layout_.width; i < line.cells.size(); ++i) {
            if (!line.cells[i].empty()) return false;
        }
        return true;
    }

    void report_width(const CsvLine& line) {
        fault("csv", "Line " + std::to_string(line.number) + " has " + std::to_string(line.cells.size()) +
                         " cells and the first line " + std::to_string(layout_.width) +
                         ". Numbers with a decimal comma need ; or tab as separator, or quotes.");
    }

    std::string_view cell(const CsvLine& line, std::size_t column) const {
        return column < line.cells.size() ? line.cells[column] : std::string_view();
    }

    void read_line(const CsvLine& line, std::optional<TimeColumn>& times) {
        double t = static_cast<double>(index_) * options_.dt.value_or(1);
        if (times) {
            const std::string_view text = cell(line, *columns_.at[kTimeRole]);
            if (is_missing(text)) {
                ++record_.dropped;
                return;
            }
            const std::string_view clock = columns_.clock ? cell(line, *columns_.clock) : std::string_view();
            if (!times->read(text, clock, line.number, t)) return report_cell(line, kTimeRole, text, times->stamps());
        }
        double u = 0, y = 0;
        if (!read_value(line, kInputRole, u) || !read_value(line, kOutputRole, y)) return;
        if (std::isnan(u) && std::isnan(y)) {
            ++record_.dropped;
            return;
        }
        if (std::abs(t) > kLargest) return report_size(line, kTimeRole);
        record_.t.push_back(t);
        record_.u.push_back(u);
        record_.y.push_back(y);
        record_.lines.push_back(line.number);
    }

    // NaN where the cell is there but holds no value.
    bool read_value(const CsvLine& line, Role role, double& value) {
        const std::string_view text = cell(line, *columns_.at[role]);
        if (read_cell_number(text, value, layout_.sign, profiles_[*columns_.at[role]].suffix)) {
            if (std::abs(value) <= kLargest) return true;
            report_size(line, role);
            return false;
        }
        if (!is_missing(text)) {
            report_cell(line, role, text, false);
            return false;
        }
        if (!text.empty() && missing_word_.empty()) missing_word_ = std::string(text);
        value = std::numeric_limits<double>::quiet_NaN();
        return true;
    }

    std::string column_name(Role role) const {
        const std::size_t column = *columns_.at[role];
        return column < layout_.headings.size() && !layout_.headings[column].empty() ? quoted(layout_.headings[column])
                                                                                     : role_name(role);
    }

    void report_cell(const CsvLine& line, Role role, std::string_view text, bool stamps) {
        const bool other_separator = line.cells.size() == 1 && layout_.width > 1;
        fault("csv", "Line " + std::to_string(line.number) + ", column " + column_name(role) + ": " + quoted(text) +
                         " is not " + (stamps ? "a time stamp like the first." : "a number.") +
                         (other_separator ? " The line is not separated like the others."
                                          : " Mend the line, or leave the cell blank to drop it."));
    }

    void report_size(const CsvLine& line, Role role) {
        fault("csv", "Line " + std::to_string(line.number) + ", column " + column_name(role) + ": " +
                         quoted(cell(line, *columns_.at[role])) +
                         " is beyond 1e30, no measurement. Mend the line, or leave the cell blank to drop it.");
    }

    void note_unit(Role role, const std::string& given, const char* name) {
        const std::size_t column = *columns_.at[role];
        std::string unit = column < layout_.headings.size() ? split_heading(layout_.headings[column]).unit : "";
        if (unit.empty() && !layout_.below.empty()) unit = std::string(cell(layout_.below.front(), column));
        if (unit.empty()) unit = profiles_[column].suffix;
        if (unit.empty() || unit == given) return;
        record_.notes.push_back(std::string(role_name(role)) + " is in " + quoted(unit) + " by the file" +
                                (given.empty() ? "."
                                               : ", and units." + std::string(name) + " is " + quoted(given) +
                                                     ": the numbers are used as they are."));
    }

    void write_notes(std::optional<TimeColumn>& times) {
        auto& notes = record_.notes;
        notes = std::move(columns_.notes);
        if (times) {
            for (std::string& note : times->take_notes()) notes.push_back(std::move(note));
        }
        if (layout_.skipped > 0)
            notes.push_back(std::to_string(layout_.skipped) + " lines above the headings were skipped.");
        if (layout_.sign == DecimalSign::comma) notes.push_back("Numbers have a decimal comma.");
        if (!missing_word_.empty()) notes.push_back(quoted(missing_word_) + " and the like are read as no value.");
        note_unit(kInputRole, options_.unit_u, "u");
        note_unit(kOutputRole, options_.unit_y, "y");
    }

    std::string_view text_;
    const CsvOptions& options_;
    CsvLayout layout_;
    std::vector<ColumnProfile> profiles_;
    FoundColumns columns_;
    std::size_t index_ = 0;
    std::string missing_word_;
    CsvRecord record_;
    std::vector<CsvFault> faults_;
};

}  // namespace

std::variant<CsvRecord, std::vector<CsvFault>> read_csv_record(std::string_view bytes, const CsvOptions& options) {
    std::string storage;
    return RecordReader(utf8_text(bytes, storage), options).read();
}

}  // namespace tunewright::api
