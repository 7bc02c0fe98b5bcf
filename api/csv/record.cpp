#include "api/csv/record.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/csv/columns/columns.h"
#include "api/csv/text.h"
#include "api/csv/time_column.h"
#include "api/csv/time_stamp.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxFaults = 10;
constexpr double kLargest = 1e30;  // as in every number of the contract

// Lines that cannot be read are left out where they are this rare: a total at the end, half a line of a serial port.
constexpr std::size_t kEnoughRows = 20, kRare = 50;

class RecordReader {
public:
    RecordReader(std::string_view text, const CsvOptions& options)
        : text_(text), options_(options), layout_(find_layout(text)) {}

    std::variant<CsvRecord, std::vector<CsvFault>> read() {
        check_layout();
        if (faults_.empty()) {
            profiles_ = profiles(text_, layout_);
            columns_ = find_columns(text_, layout_, profiles_, options_, faults_);
        }
        if (faults_.empty()) read_lines();
        if (faults_.empty() && record_.t.empty())
            fault("csv", "csv has no complete sample: every line lacks t, u or y.");
        if (!faults_.empty()) return std::move(faults_);
        return std::move(record_);
    }

private:
    void fault(std::string where, std::string message) {
        if (faults_.size() < kMaxFaults) faults_.push_back({std::move(where), std::move(message)});
    }

    std::string no_data() const {
        if (layout_.lines_of_text == 0)
            return "csv is empty; it needs a heading line such as t,u,y and lines of numbers.";
        for (const std::string& text : layout_.headings) {
            for (const Role role : {kTimeRole, kInputRole, kOutputRole}) {
                const auto named = match(split_heading(text), role);
                if (named && named->level == 1) return "csv has headings but no line of numbers.";
            }
        }
        return "csv has no line of numbers in columns, nor lines that name two values or more each; it begins with " +
               in_quotes(first_line()) +
               ". Export a heading line such as t,u,y and one line a sample, with all its values.";
    }

    void check_layout() {
        if (layout_.data_line == 0) {
            fault("csv", no_data());
        } else if (layout_.headings.empty() && layout_.narrow_heading_line > 0) {
            fault("csv", "Line " + std::to_string(layout_.narrow_heading_line) + " has " +
                             std::to_string(layout_.narrow_heading_cells) + " headings and line " +
                             std::to_string(layout_.data_line) + " has " + std::to_string(layout_.width) +
                             " cells. Numbers with a decimal comma need ; or tab as separator, or quotes.");
        }
    }

    std::string_view first_line() const {
        std::string_view text = trimmed(text_);
        return text.substr(0, text.find_first_of("\r\n"));
    }

    // Times of a file that has none: from the spacing that is given, or that a column holds.
    double spacing() const {
        if (options_.dt || !columns_.spacing) return options_.dt.value_or(1);
        const std::size_t column = *columns_.spacing;
        const auto unit = seconds_per(split_heading(layout_.headings[column]).unit),
                   answer = seconds_per(options_.time_unit);
        return profiles_[column].first * (unit && answer ? *unit / *answer : 1);
    }

    void read_lines() {
        skip_head();
        spacing_ = spacing();
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
            if (faults_.size() >= kMaxFaults) return;
            if (record_.t.size() > options_.most_samples) {
                return fault("csv", "csv has more than " + std::to_string(options_.most_samples) +
                                        " samples; thin it out: a few thousand identify as well.");
            }
        }
        if (unread_ > 0 && (record_.t.size() < kEnoughRows || (unread_ - 1) * kRare >= record_.t.size()))
            return void(faults_ = std::move(unread_faults_));
        record_.dropped += static_cast<int>(unread_);
        record_.time_unit_known = options_.dt || columns_.spacing || !times || times->unit_known();
        hold_reference();
        write_notes(times);
    }

    void skip(int line, std::string reason) {
        if (record_.skipped.size() < kMostSkips) record_.skipped.push_back({line, std::move(reason)});
    }

    // The lines before the first row that are not its headings.
    void skip_head() {
        std::size_t at = 0;
        for (int number = 1; number < layout_.data_line; ++number) {
            const auto line = next_line(text_, at);
            if (!line) return;
            const std::string_view content = trimmed(*line);
            if (content.empty() || number == layout_.heading_line || layout_.pairs) continue;
            const bool below = layout_.heading_line > 0 && number > layout_.heading_line;
            skip(number, is_comment(content) ? "a comment"
                         : below             ? "units or descriptions, no numbers"
                                             : "above the headings");
        }
    }

    // A line that does not belong to the table, for `reason`. Many of them are no accident.
    void unread(const CsvLine& line, std::string reason, const std::string& cure) {
        ++unread_;
        const std::string sentence = "Line " + std::to_string(line.number) + reason;
        if (unread_faults_.size() < kMaxFaults) unread_faults_.push_back({"csv", sentence + cure});
        reason.erase(0, reason.find_first_not_of(", "));
        skip(line.number, std::move(reason));
    }

    // A set point that is written where it changes holds until the next one; the first one holds from the beginning.
    void hold_reference() {
        std::vector<double>& r = record_.r;
        const auto known = std::find_if(r.begin(), r.end(), [](double value) { return !std::isnan(value); });
        if (known == r.end() && !r.empty())
            columns_.notes.emplace_back("The column of the set point holds no number; there is none in the record.");
        if (known == r.end()) return r.clear();
        double last = *known;
        for (double& value : r) last = value = std::isnan(value) ? last : value;
    }

    void reserve() {
        constexpr std::size_t kMinLineLength = 6;
        const std::size_t typical = layout_.width * 4 + kMinLineLength;
        const std::size_t most = std::min(options_.most_samples, text_.size() / typical + 1);
        for (auto* column : {&record_.t, &record_.u, &record_.y}) column->reserve(most);
        if (columns_.at[kReferenceRole]) record_.r.reserve(most);
        record_.lines.reserve(most);
    }

    bool only_blanks_beyond(const CsvLine& line) const {
        for (std::size_t i = layout_.width; i < line.cells.size(); ++i) {
            if (!line.cells[i].empty()) return false;
        }
        return true;
    }

    void report_width(const CsvLine& line) {
        unread(line,
               " has " + std::to_string(line.cells.size()) + " cells and the first line " +
                   std::to_string(layout_.width) + ".",
               " Numbers with a decimal comma need ; or tab as separator, or quotes.");
    }

    std::string_view cell(const CsvLine& line, std::size_t column) const {
        return column < line.cells.size() ? line.cells[column] : std::string_view();
    }

    void read_line(const CsvLine& line, std::optional<TimeColumn>& times) {
        double t = static_cast<double>(index_) * spacing_;
        if (times) {
            const std::string_view text = cell(line, *columns_.at[kTimeRole]);
            if (is_missing(text)) {
                ++record_.dropped;
                return skip(line.number, "no time");
            }
            const std::string_view clock = columns_.clock ? cell(line, *columns_.clock) : std::string_view();
            if (!times->read(text, clock, line.number, t)) return report_cell(line, kTimeRole, text, times->stamps());
        }
        double u = 0, y = 0, r = std::numeric_limits<double>::quiet_NaN();
        if (!read_value(line, kInputRole, u) || !read_value(line, kOutputRole, y)) return;
        if (columns_.at[kReferenceRole]) r = read_reference(line);
        if (std::isnan(u) && std::isnan(y)) {
            ++record_.dropped;
            return skip(line.number, "neither u nor y");
        }
        if (std::abs(t) > kLargest) return report_size(line, kTimeRole);
        record_.t.push_back(t);
        record_.u.push_back(u);
        record_.y.push_back(y);
        if (columns_.at[kReferenceRole]) record_.r.push_back(r);
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
        if (role == kInputRole && read_switch(text, value)) return true;
        if (!is_missing(text)) {
            report_cell(line, role, text, false);
            return false;
        }
        if (!text.empty() && missing_word_.empty()) missing_word_ = std::string(text);
        value = std::numeric_limits<double>::quiet_NaN();
        return true;
    }

    // Whatever stands for "none" in a set point: nothing depends on it.
    double read_reference(const CsvLine& line) const {
        const std::size_t column = *columns_.at[kReferenceRole];
        double value = 0;
        const bool number = read_cell_number(cell(line, column), value, layout_.sign, profiles_[column].suffix);
        return number && std::abs(value) <= kLargest ? value : std::numeric_limits<double>::quiet_NaN();
    }

    // Words of u are its two levels; beside numbers they would be a guess.
    bool read_switch(std::string_view text, double& value) {
        const auto level = switch_word(text);
        if (!level || profiles_[*columns_.at[kInputRole]].numbers > 0) return false;
        value = *level;
        std::string& word = *level > 0 ? high_word_ : low_word_;
        if (word.empty()) word = std::string(text);
        return true;
    }

    std::string column_name(Role role) const {
        const std::size_t column = *columns_.at[role];
        return column < layout_.headings.size() && !layout_.headings[column].empty()
                   ? in_quotes(layout_.headings[column])
                   : role_name(role);
    }

    void report_cell(const CsvLine& line, Role role, std::string_view text, bool stamps) {
        const bool other_separator = line.cells.size() == 1 && layout_.width > 1;
        const std::string reason = ", column " + column_name(role) + ": " + in_quotes(text) + " is not " +
                                   (stamps ? "a time stamp like the first." : "a number.");
        const char* cure = other_separator ? " The line is not separated like the others."
                                           : " Mend the line, or leave the cell blank to drop it.";
        // ON and OFF among numbers mean something, which is not known.
        if (role == kInputRole && switch_word(text))
            return fault("csv", "Line " + std::to_string(line.number) + reason + cure);
        unread(line, reason, cure);
    }

    void report_size(const CsvLine& line, Role role) {
        fault("csv", "Line " + std::to_string(line.number) + ", column " + column_name(role) + ": " +
                         in_quotes(cell(line, *columns_.at[role])) +
                         " is beyond 1e30, no measurement. Mend the line, or leave the cell blank to drop it.");
    }

    void note_switch() {
        std::string levels;
        if (!low_word_.empty()) levels = in_quotes(low_word_) + " is 0";
        if (!high_word_.empty()) levels += (levels.empty() ? "" : " and ") + in_quotes(high_word_) + " is 1";
        if (!levels.empty())
            record_.notes.emplace_back("u is two levels: " + levels +
                                       ". The gain is per switch, not per unit of power.");
    }

    void note_sign() {
        auto& notes = record_.notes;
        const std::string& open = layout_.open_number;
        const bool comma = open.find(',') != std::string::npos;
        const bool of_thousands = layout_.sign == (comma ? DecimalSign::point : DecimalSign::comma);
        if (!open.empty() && layout_.sign == DecimalSign::either)
            notes.push_back("Numbers such as " + in_quotes(open) +
                            " are read with three decimals. If they are thousands, write them without the " +
                            (comma ? "comma." : "point."));
        else if (!open.empty() && of_thousands)
            notes.push_back("Numbers such as " + in_quotes(open) +
                            " are read as thousands: whole numbers stand beside them in the column.");
        else if (layout_.sign == DecimalSign::comma)
            notes.emplace_back("Numbers have a decimal comma.");
    }

    void note_unit(Role role, const std::string& given) {
        const std::size_t column = *columns_.at[role];
        std::string unit = column < layout_.headings.size() ? split_heading(layout_.headings[column]).unit : "";
        if (unit.empty() && !layout_.below.empty()) unit = std::string(cell(layout_.below.front(), column));
        if (unit.empty()) unit = profiles_[column].suffix;
        if (unit.empty() || unit == given) return;
        record_.notes.push_back(
            role_name(role) + " is in " + in_quotes(unit) + " by the file" +
            (given.empty() ? "." : ", and " + in_quotes(given) + " was given: the numbers are used as they are."));
    }

    void write_notes(std::optional<TimeColumn>& times) {
        auto& notes = record_.notes;
        notes = std::move(columns_.notes);
        if (times) {
            for (std::string& note : times->take_notes()) notes.push_back(std::move(note));
        }
        if (columns_.spacing)
            notes.emplace_back("Times are made from column " + in_quotes(layout_.headings[*columns_.spacing]) +
                               ", the spacing: " + tunewright::text(spacing_) + " " + options_.time_unit + ".");
        if (layout_.skipped > 0)
            notes.push_back(std::to_string(layout_.skipped) +
                            (layout_.skipped == 1 ? " line above the headings was" : " lines above the headings were") +
                            " skipped.");
        if (layout_.pairs) notes.emplace_back("Each line names its values; lines without them were passed over.");
        if (layout_.commented)
            notes.emplace_back("The headings are those of the comment in line " + std::to_string(layout_.heading_line) +
                               ".");
        if (layout_.numbered) notes.emplace_back("The first column, which has no heading, numbers the rows.");
        note_switch();
        note_sign();
        if (unread_ > 0) {
            const std::string& first = unread_faults_.front().message;
            record_.unread = std::to_string(unread_) + (unread_ == 1 ? " line" : " lines") + " could not be read and " +
                             (unread_ == 1 ? "was" : "were") + " left out: " + first.substr(0, first.find(". ")) + ".";
        }
        if (!missing_word_.empty()) notes.push_back(in_quotes(missing_word_) + " and the like are read as no value.");
        note_unit(kInputRole, options_.unit_u);
        note_unit(kOutputRole, options_.unit_y);
    }

    std::string_view text_;
    const CsvOptions& options_;
    CsvLayout layout_;
    std::vector<ColumnProfile> profiles_;
    FoundColumns columns_;
    std::size_t index_ = 0, unread_ = 0;
    std::vector<CsvFault> unread_faults_;
    double spacing_ = 1;
    std::string missing_word_, low_word_, high_word_;
    CsvRecord record_;
    std::vector<CsvFault> faults_;
};

}  // namespace

std::variant<CsvRecord, std::vector<CsvFault>> read_csv_record(std::string_view bytes, const CsvOptions& options) {
    std::string storage;
    return RecordReader(utf8_text(bytes, storage), options).read();
}

}  // namespace tunewright::api
