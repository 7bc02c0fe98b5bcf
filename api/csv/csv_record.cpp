#include "api/csv/csv_record.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "api/csv/columns/columns.h"
#include "api/csv/columns/loop_mode.h"
#include "api/csv/record_notes.h"
#include "api/csv/shape/held_values.h"
#include "api/csv/shape/runs.h"
#include "api/csv/shape/shape.h"
#include "api/csv/text.h"
#include "api/csv/time_column.h"
#include "api/csv/time_stamp.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxFaults = 10;
constexpr double kMaxNumber = 1e30;  // as in every number of the contract
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

// Lines that cannot be read are left out if they are this rare: a total at the end, half a line of a serial port.
constexpr std::size_t kMinReadRows = 20, kMinRowsPerUnread = 50;

class RecordReader {
public:
    RecordReader(const CsvSource& source, const CsvOptions& options)
        : source_(source), text_(source.text()), options_(options), layout_(source.layout()) {}

    std::variant<CsvRecord, std::vector<CsvFault>> read() {
        if (!source_.fault().empty())
            fault(source_.fault_at(), source_.fault());
        else
            check_layout();
        if (faults_.empty()) {
            profiles_ = profiles(text_, layout_);
            columns_ = find_columns(text_, layout_, profiles_, options_, faults_);
        }
        if (faults_.empty()) read_lines();
        if (faults_.empty() && record_.t.empty())
            fault("csv", "csv has no complete sample: every line lacks t, u or y.");
        if (faults_.empty()) choose_run();
        if (!faults_.empty()) return std::move(faults_);
        return std::move(record_);
    }

private:
    void fault(std::string where, std::string message) {
        if (faults_.size() < kMaxFaults) faults_.push_back({std::move(where), std::move(message)});
    }

    void check_layout() {
        if (layout_.data_line == 0) {
            fault("csv", no_data_sentence(layout_, first_line()));
        } else if (layout_.headings.empty() && layout_.narrow_heading_line > 0) {
            fault("csv", "Line " + std::to_string(layout_.narrow_heading_line) + " has " +
                             std::to_string(layout_.narrow_heading_cells) + " headings and line " +
                             std::to_string(layout_.data_line) + " has " + std::to_string(layout_.width) +
                             " cells. Numbers with a decimal comma need ; or tab as separator, or quotes.");
        }
    }

    void choose_run() {
        if (auto wrong = take_run(record_, options_.run)) faults_.push_back(*std::move(wrong));
    }

    std::string_view first_line() const {
        std::string_view text = trimmed(source_.file_text());
        return text.substr(0, text.find_first_of("\r\n"));
    }

    void read_lines() {
        skip_head();
        if (options_.dt || columns_.spacing)
            spacing_ = options_.dt ? *options_.dt : spacing_of(*columns_.spacing, options_);
        std::optional<TimeColumn> times;
        if (columns_.at[kTimeRole])
            times.emplace(text_, layout_, columns_, profiles_[*columns_.at[kTimeRole]], options_, faults_);
        if (!faults_.empty()) return;
        reserve();
        CsvLines lines(text_, layout_);
        CsvLine line;
        while (lines.next(line)) {
            if (are_headings(line))
                skip(line.number, "the headings again");
            else if (line.cells.size() > layout_.width && !only_blanks_beyond(line))
                report_width(line);
            else
                read_line(line, times);
            ++index_;
            if (faults_.size() >= kMaxFaults) return;
            if (record_.t.size() > options_.max_samples) {
                return fault("csv", "csv has more than " + std::to_string(options_.max_samples) +
                                        " samples; thin it out: a few thousand are sufficient.");
            }
        }
        if (unread_ > 0 && (record_.t.size() < kMinReadRows || (unread_ - 1) * kMinRowsPerUnread >= record_.t.size()))
            return void(faults_ = std::move(unread_faults_));
        record_.dropped += static_cast<int>(unread_);
        record_.time_unit_known = options_.dt || (columns_.spacing ? unit_is_known(*columns_.spacing, options_)
                                                                   : !times || times->unit_known());
        if (columns_.at[kReferenceRole] && !hold_reference(record_.r))
            columns_.notes.emplace_back("The column of the set point contains no number; the record has no set point.");
        if (mode_) record_.unknown_mode = mode_->unknown(), record_.automatic = mode_->take();
        if (layout_.pivoted) hold_input(record_);
        write_notes(times);
    }

    // A logger that was restarted writes the headings again.
    bool are_headings(const CsvLine& line) const {
        if (layout_.headings.empty() || layout_.pairs || line.cells.front().empty()) return false;
        return std::equal(line.cells.begin(), line.cells.end(), layout_.headings.begin(), layout_.headings.end());
    }

    void skip(int line, std::string reason) {
        if (record_.skipped.size() < kMaxSkips) record_.skipped.push_back({line, std::move(reason)});
    }

    // Skips the lines before the first row that are not its headings.
    void skip_head() {
        if (!layout_.source_lines.empty()) return;
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

    // Records a line that does not belong to the table, for `reason`; `joint` joins that to the line's name. Many such
    // lines are a fault.
    void unread(const CsvLine& line, const char* joint, std::string reason, const std::string& cure) {
        const std::string sentence = "Line " + std::to_string(line.number) + joint + reason;
        if (++unread_ == 1) first_unread_ = sentence;
        if (unread_faults_.size() < kMaxFaults) unread_faults_.push_back({"csv", sentence + cure});
        skip(line.number, std::move(reason));
    }

    void reserve() {
        constexpr std::size_t kMinLineLength = 6;
        const std::size_t typical = layout_.width * 4 + kMinLineLength;
        const std::size_t max = std::min(options_.max_samples, text_.size() / typical + 1);
        for (auto* column : {&record_.t, &record_.u, &record_.y}) column->reserve(max);
        if (columns_.at[kReferenceRole]) record_.r.reserve(max);
        if (const auto column = columns_.at[kModeRole])
            mode_.emplace(mode_codes(split_heading(heading_of(*column, ""))));
        for (const std::size_t column : columns_.d) record_.d.push_back({disturbance_name(column), {}});
        d_.assign(columns_.d.size(), kNoNumber);
        last_d_ = d_;
        record_.lines.reserve(max);
    }

    bool only_blanks_beyond(const CsvLine& line) const {
        for (std::size_t i = layout_.width; i < line.cells.size(); ++i) {
            if (!line.cells[i].empty()) return false;
        }
        return true;
    }

    void report_width(const CsvLine& line) {
        unread(line, " ",
               "has " + std::to_string(line.cells.size()) + " cells and the first line " +
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
        double u = 0, y = 0;
        if (options_.u_step) u = (*options_.u_step)[1];
        if ((columns_.at[kInputRole] && !read_value(line, kInputRole, u)) || !read_value(line, kOutputRole, y)) return;
        const bool others = read_others(line);
        // The step of a file without u is at its first row, even if y is missing there.
        const bool stepped = options_.u_step && (layout_.pivoted || !record_.t.empty());
        if (std::isnan(y) && (std::isnan(u) || stepped)) {
            if (!others && !layout_.pivoted) {
                ++record_.dropped;
                skip(line.number, "neither u nor y");
            }
            if (!disturbance_moved()) return;
            u = last_u_;
        }
        if (std::abs(t) > kMaxNumber) return report_size(line, kTimeRole);
        push(t, u, y, line.number);
    }

    void push(double t, double u, double y, int line) {
        record_.t.push_back(t);
        record_.u.push_back(u);
        record_.y.push_back(y);
        if (!std::isnan(u)) last_u_ = u;
        if (columns_.at[kReferenceRole]) record_.r.push_back(std::exchange(r_, kNoNumber));
        if (mode_) mode_->add_row();
        for (std::size_t k = 0; k < d_.size(); ++k) {
            if (!std::isnan(d_[k])) last_d_[k] = d_[k];
            record_.d[k].values.push_back(std::exchange(d_[k], kNoNumber));
        }
        record_.lines.push_back(line);
    }

    // Reads set point, mode and disturbances, which hold until the next row that counts: a line may have only one of
    // them.
    bool read_others(const CsvLine& line) {
        bool any = false;
        const auto take = [&](std::size_t column, double& target) {
            const double value = read_optional(line, column);
            if (std::isnan(value)) return;
            target = value;
            any = true;
        };
        if (columns_.at[kReferenceRole]) take(*columns_.at[kReferenceRole], r_);
        for (std::size_t k = 0; k < d_.size(); ++k) take(columns_.d[k], d_[k]);
        if (mode_) any = mode_->see(cell(line, *columns_.at[kModeRole])) || any;
        return any;
    }

    bool disturbance_moved() const {
        for (std::size_t k = 0; k < d_.size(); ++k)
            if (!std::isnan(d_[k]) && d_[k] != last_d_[k]) return !std::isnan(last_u_);
        return false;
    }

    // True if u consists of words such as ON and OFF.
    bool of_words(ColumnRole role) const {
        const ColumnProfile& held = profiles_[*columns_.at[role]];
        return role == kInputRole && held.switches > held.numbers;
    }

    // Gives NaN if the cell is there but holds no value.
    bool read_value(const CsvLine& line, ColumnRole role, double& value) {
        const std::string_view text = cell(line, *columns_.at[role]);
        const ColumnProfile& held = profiles_[*columns_.at[role]];
        if (!of_words(role) && read_cell_number(text, value, layout_.sign, held.suffix)) {
            if (std::abs(value) <= kMaxNumber) return true;
            report_size(line, role);
            return false;
        }
        if (of_words(role) && read_switch(text, value)) return true;
        if (!is_missing(text)) {
            report_cell(line, role, text, false);
            return false;
        }
        if (!text.empty() && missing_word_.empty()) missing_word_ = std::string(text);
        value = kNoNumber;
        return true;
    }

    // Any mark for "none" in a set point or a disturbance: the previous value holds.
    double read_optional(const CsvLine& line, std::size_t column) const {
        double value = 0;
        const bool number = read_cell_number(cell(line, column), value, layout_.sign, profiles_[column].suffix);
        return number && std::abs(value) <= kMaxNumber ? value : kNoNumber;
    }

    // The words of u are its two levels; numbers among them are damaged cells.
    bool read_switch(std::string_view text, double& value) {
        const auto level = switch_word(text);
        if (!level) return false;
        value = *level;
        std::string& word = *level > 0 ? high_word_ : low_word_;
        if (word.empty()) word = std::string(text);
        return true;
    }

    std::string heading_of(std::size_t column, const std::string& without) const {
        return column < layout_.headings.size() && !layout_.headings[column].empty() ? layout_.headings[column]
                                                                                     : without;
    }

    // Headings may be missing or occur twice.
    std::string disturbance_name(std::size_t column) const {
        const std::string name = heading_of(column, "d");
        const auto same =
            std::ranges::count_if(columns_.d, [&](std::size_t other) { return heading_of(other, "d") == name; });
        return same > 1 ? name + " (column " + std::to_string(column + 1) + ")" : name;
    }

    std::string column_name(ColumnRole role) const {
        const std::string heading = heading_of(*columns_.at[role], "");
        return heading.empty() ? role_name(role) : in_quotes(heading);
    }

    void report_cell(const CsvLine& line, ColumnRole role, std::string_view text, bool stamps) {
        const bool other_separator = line.cells.size() == 1 && layout_.width > 1;
        const std::string reason = "column " + column_name(role) + ": " + in_quotes(text) + " is not " +
                                   (stamps           ? "a time stamp like the first one."
                                    : of_words(role) ? "one of the column's two words."
                                                     : "a number.");
        const char* cure = other_separator ? " The line is not separated like the others."
                                           : " Correct the line, or leave the cell blank to drop it.";
        // ON and OFF among numbers have a meaning that is not known.
        if (role == kInputRole && switch_word(text))
            return fault("csv", "Line " + std::to_string(line.number) + ", " + reason + cure);
        unread(line, ", ", reason, cure);
    }

    void report_size(const CsvLine& line, ColumnRole role) {
        fault("csv", "Line " + std::to_string(line.number) + ", column " + column_name(role) + ": " +
                         in_quotes(cell(line, *columns_.at[role])) +
                         " is beyond 1e30, which cannot be a measurement. Correct the line, or leave the cell blank to "
                         "drop it.");
    }

    void note_unit(ColumnRole role, const std::string& given) {
        if (!columns_.at[role]) return;
        const std::string unit =
            of_words(role) ? "" : unit_of(layout_, profiles_[*columns_.at[role]], *columns_.at[role]);
        if (unit.empty() || unit == given) return;
        record_.notes.push_back(
            role_name(role) + " is in " + in_quotes(unit) + " by the file" +
            (given.empty() ? "." : ", and " + in_quotes(given) + " was given: the numbers are used as they are."));
    }

    void write_notes(std::optional<TimeColumn>& times) {
        auto& notes = record_.notes;
        notes = source_.notes();
        record_.unread_column = std::move(columns_.unread);
        std::ranges::move(columns_.notes, std::back_inserter(notes));
        if (times) {
            for (std::string& note : times->take_notes()) notes.push_back(std::move(note));
        }
        if (columns_.spacing) notes.push_back(spacing_note(*columns_.spacing, options_));
        if (options_.u_step)
            notes.emplace_back("u steps from " + tunewright::text((*options_.u_step)[0]) + " to " +
                               tunewright::text((*options_.u_step)[1]) + " at the first row, as given.");
        if (layout_.skipped > 0)
            notes.push_back(std::to_string(layout_.skipped) +
                            (layout_.skipped == 1 ? " line above the headings was" : " lines above the headings were") +
                            " skipped.");
        if (layout_.pairs) notes.emplace_back("Each line names its values; other lines were skipped.");
        if (layout_.commented)
            notes.emplace_back("The headings were read from the comment in line " +
                               std::to_string(layout_.heading_line) + ".");
        if (layout_.numbered) notes.emplace_back("The first column, which has no heading, contains row numbers.");
        if (auto note = switch_note(low_word_, high_word_); !note.empty()) notes.push_back(std::move(note));
        if (auto note = sign_note(layout_); !note.empty()) notes.push_back(std::move(note));
        if (unread_ > 0)
            record_.unread = std::to_string(unread_) + (unread_ == 1 ? " line" : " lines") + " could not be read and " +
                             (unread_ == 1 ? "was" : "were") + " left out: " + first_unread_;
        if (!missing_word_.empty())
            notes.push_back(in_quotes(missing_word_) + " and similar texts are read as missing values.");
        record_.u_stepped = options_.u_step.has_value();
        if (const auto u = columns_.at[kInputRole];
            u && (is_percent(layout_, profiles_[*u], *u) || options_.unit_u == "%"))
            record_.u_full_scale = 100;
        note_unit(kInputRole, options_.unit_u);
        note_unit(kOutputRole, options_.unit_y);
    }

    const CsvSource& source_;
    std::string_view text_;
    const CsvOptions& options_;
    const CsvLayout& layout_;
    std::vector<ColumnProfile> profiles_;
    DetectedColumns columns_;
    std::size_t index_ = 0, unread_ = 0;
    std::vector<CsvFault> unread_faults_;
    std::string first_unread_;
    double spacing_ = 1;
    double r_ = kNoNumber, last_u_ = kNoNumber;  // r_, d_: read, but not yet in a row of the record
    std::optional<ModeColumn> mode_;
    std::vector<double> d_, last_d_;
    std::string missing_word_, low_word_, high_word_;
    CsvRecord record_;
    std::vector<CsvFault> faults_;
};

}  // namespace

std::variant<CsvRecord, std::vector<CsvFault>> read_csv_record(std::string_view bytes, const CsvOptions& options) {
    const CsvSource source(bytes, options.columns);
    return read_csv_record(source, options);
}

std::variant<CsvRecord, std::vector<CsvFault>> read_csv_record(const CsvSource& source, const CsvOptions& options) {
    return RecordReader(source, options).read();
}

}  // namespace tunewright::api
