#include "api/csv/time_column.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"

namespace tunewright::api {
namespace {

constexpr double kMinute = 60;

/// True for "12:05", whose two numbers may be hours and minutes or minutes and seconds.
bool is_short(const TimeStamp& stamp, std::string_view cell) {
    return !stamp.has_date && !stamp.minutes && std::ranges::count(cell, ':') == 1;
}

/// True if a number is a day of the years 1954 to 2119 in spreadsheets' counting, or of 1916 to 2190 in MATLAB's
/// datenum.
bool is_day(double value) { return (value > 20000 && value < 80000) || (value > 700000 && value < 800000); }

constexpr double kSpreadsheetDayOf1970 = 25569, kMatlabDayOf1970 = 719529;
constexpr double kFrom1970 = 3e8, kTo1970 = 5e9;  ///< seconds since 1970: 1979 to 2128

/// True if steps, in days, are as long as those of logs: seconds that divide a minute, or minutes.
bool steps_of_a_log(double days) {
    constexpr double kMaxSecondsOff = 0.02;  // seconds
    const double seconds = days * kDay, whole = std::round(seconds);
    if (std::abs(seconds - whole) > kMaxSecondsOff || whole < 1 || whole > kHour) return false;
    return std::fmod(whole < kMinute ? kMinute : whole, whole < kMinute ? whole : kMinute) == 0;
}

/// True if steps, in days, are whole seconds, or whole minutes if they are longer. Their decimals do not end, unlike
/// those of a sample time in seconds.
bool steps_of_a_clock(double days) {
    constexpr double kMaxSecondsOff = 0.1, kShort = 90, kLong = 1801;  // seconds
    constexpr double kLastDecimal = 1e-7, kEnds = 0.02;
    const double seconds = days * kDay, unit = seconds < kShort ? 1 : kMinute;
    if (std::abs(std::remainder(days / kLastDecimal, 1)) < kEnds) return false;
    return seconds > 1 - kMaxSecondsOff && seconds < kLong && std::abs(std::remainder(seconds, unit)) < kMaxSecondsOff;
}

}  // namespace

TimeColumn::TimeColumn(std::string_view text, const CsvLayout& layout, const DetectedColumns& columns,
                       const ColumnProfile& profile, const CsvOptions& options, std::vector<CsvFault>& faults)
    : stamps_(profile.stamps > profile.numbers),
      sign_(layout.sign),
      suffix_(profile.suffix),
      answer_s_(seconds_per(options.time_unit).value_or(0)) {
    if (!stamps_) {
        find_unit(text, layout, columns, profile, options);
        return;
    }
    const auto answer = seconds_per(options.time_unit);
    if (!answer) {
        faults.push_back({"csv", "The times are time stamps, and the unit of time is " + in_quotes(options.time_unit) +
                                     "; it must be a unit that they can be converted to: ms, s, min, h or d."});
        return;
    }
    factor_ = 1 / *answer;
    read_short_clock(text, layout, *columns.at[kTimeRole]);
    find_order(text, layout, columns);
}

// "00:05" may also be minutes and seconds: it is, if one of the cells exceeds the hours of a day.
void TimeColumn::read_short_clock(std::string_view text, const CsvLayout& layout, std::size_t column) {
    CsvLines lines(text, layout);
    CsvLine line;
    std::string first;
    while (!short_is_minutes_ && lines.next(line)) {
        if (column >= line.cells.size() || is_missing(line.cells[column])) continue;
        const std::string_view cell = line.cells[column];
        const auto stamp = read_time_stamp(cell);
        if (!stamp) continue;
        if (stamp->minutes) notes_.push_back("Times such as " + in_quotes(cell) + " are read as minutes and seconds.");
        if (!is_short(*stamp, cell)) return;
        if (first.empty()) first = std::string(cell);
        short_is_minutes_ = stamp->seconds > kDay;
        if (short_is_minutes_)
            notes_.push_back("Times such as " + in_quotes(first) + " are read as minutes and seconds, because " +
                             in_quotes(cell) + " is not a time of day; write " + std::string(cell) +
                             ":00 for hours and minutes.");
    }
    if (short_is_minutes_ || first.empty()) return;
    notes_.push_back("Times such as " + in_quotes(first) + " are read as hours and minutes; write 0:" + first +
                     " for minutes and seconds.");
}

// 03/04/2026 has two readings: the right one is that in which time increases; the other jumps by months.
void TimeColumn::find_order(std::string_view text, const CsvLayout& layout, const DetectedColumns& columns) {
    CsvLines lines(text, layout);
    CsvLine line;
    double way[2] = {}, last[2] = {};
    bool matters = false, any = false;
    constexpr int kProbedLines = 2000;
    const std::size_t at = *columns.at[kTimeRole];
    for (int n = 0; lines.next(line) && (matters || n < kProbedLines); ++n) {
        if (at >= line.cells.size()) continue;
        const auto day = read_time_stamp(line.cells[at], DateOrder::day_first);
        const auto month = read_time_stamp(line.cells[at], DateOrder::month_first);
        if (!day || !month) continue;
        matters = matters || day->order_matters;
        const double now[2] = {day->seconds, month->seconds};
        for (int k = 0; k < 2; ++k) {
            if (any) way[k] += std::abs(now[k] - last[k]);
            last[k] = now[k];
        }
        any = true;
    }
    order_ = way[1] < way[0] ? DateOrder::month_first : DateOrder::day_first;
    if (matters && way[0] != way[1]) {
        notes_.push_back(std::string("Dates are read with the ") + (order_ == DateOrder::day_first ? "day" : "month") +
                         " first, because the times would otherwise jump.");
    }
}

// Counters since 1970 in milliseconds or smaller units are far larger than other numbers; spreadsheets count days.
std::optional<std::string> TimeColumn::unit_by_size(std::string_view text, const CsvLayout& layout,
                                                    std::size_t column) const {
    CsvLines lines(text, layout);
    CsvLine line;
    std::optional<double> first, last;
    double steps = 0;
    constexpr int kProbedLines = 200;
    for (int n = 0; n < kProbedLines && lines.next(line); ++n) {
        double value = 0;
        if (column >= line.cells.size() || !read_cell_number(line.cells[column], value, sign_, suffix_)) continue;
        if (!first) first = value;
        if (last) steps += 1;
        last = value;
    }
    if (!first || steps < 1) return std::nullopt;
    constexpr double kFromMidnight = 20;  // steps
    for (const auto& [unit, scale] : {std::pair{"ms", 1e3}, {"us", 1e6}, {"ns", 1e9}}) {
        if (*first > kFrom1970 * scale && *first < kTo1970 * scale) return unit;
    }
    const std::string name = column < layout.headings.size() ? split_heading(layout.headings[column]).name : "";
    const bool dated = name.find("date") != name.npos || name.find("stamp") != name.npos ||
                       name.find("datum") != name.npos || name.find("zeitstempel") != name.npos;
    const double mean_step = std::abs(*last - *first) / steps;
    if (is_day(*first) && mean_step > 0 && mean_step < 0.05 && (dated || steps_of_a_clock(mean_step))) return "d";
    // A time of day alone, as spreadsheets store it; a record in seconds begins at or near 0.
    const bool of_day = *first > kFromMidnight * mean_step && *last < 1 && *last > *first;
    if (of_day && steps_of_a_clock(mean_step) && steps_of_a_log(mean_step)) return "d";
    return std::nullopt;
}

// A log with its own clock, such as that of a serial monitor, next to a counter: the clock gives the rate of the
// counter.
std::optional<std::string> TimeColumn::unit_by_clock(std::string_view text, const CsvLayout& layout,
                                                     std::size_t column) const {
    constexpr int kProbedLines = 2000, kMaxLinesWithoutClock = 20;
    constexpr double kMinDurationSeconds = 20, kMaxRelativeDifference = 0.1;  // seconds; relative
    CsvLines lines(text, layout);
    CsvLine line;
    double first = 0, last = 0, began = 0, ended = 0;
    std::optional<std::size_t> clock;
    for (int n = 0; n < kProbedLines && lines.next(line); ++n) {
        if (column >= line.cells.size() || !read_cell_number(line.cells[column], last, sign_, suffix_)) continue;
        for (std::size_t other = 0; !clock && other < line.cells.size(); ++other) {
            const auto stamp = other == column ? std::nullopt : read_time_stamp(line.cells[other]);
            if (!stamp || !stamp->has_clock) continue;
            clock = other;
            began = stamp->seconds;
            first = last;
        }
        if (!clock && n >= kMaxLinesWithoutClock) return std::nullopt;
        if (!clock || *clock >= line.cells.size()) continue;
        if (const auto stamp = read_time_stamp(line.cells[*clock])) ended = stamp->seconds;
    }
    if (!clock || ended - began < kMinDurationSeconds) return std::nullopt;
    const double a_second = (last - first) / (ended - began);
    for (const auto& [unit, scale] :
         {std::pair{"s", 1.0}, {"ms", 1e3}, {"us", 1e6}, {"min", 1 / 60.0}, {"h", 1 / kHour}})
        if (std::abs(a_second / scale - 1) < kMaxRelativeDifference) return unit;
    return std::nullopt;
}

void TimeColumn::find_unit(std::string_view text, const CsvLayout& layout, const DetectedColumns& columns,
                           const ColumnProfile& profile, const CsvOptions& options) {
    const std::size_t column = *columns.at[kTimeRole];
    std::string unit = options.file_time_unit;
    if (unit.empty() && column < layout.headings.size()) unit = split_heading(layout.headings[column]).unit;
    for (const CsvLine& below : layout.below) {
        if (!seconds_per(unit) && column < below.cells.size()) unit = std::string(below.cells[column]);
        if (!seconds_per(unit) && unit.size() > 2 && (unit.front() == '[' || unit.front() == '('))
            unit = unit.substr(1, unit.size() - 2);
    }
    if (!seconds_per(unit) && column < layout.headings.size()) {
        const std::string name = split_heading(layout.headings[column]).name;
        constexpr std::size_t kMinWordLength = 5;  // from this number of letters on, a name is not a symbol
        const bool of_time = name.size() >= kMinWordLength || match(split_heading(layout.headings[column]), kTimeRole);
        if (seconds_per(name) && of_time && name != "m" && name != "d") unit = name;
        if (name == "millis" || name == "millis()") unit = "ms";
        if (name == "micros") unit = "us";
    }
    if (!seconds_per(unit)) unit = profile.suffix;
    bool by_size = false;
    if (!seconds_per(unit)) {
        if (const auto found = unit_by_size(text, layout, column)) {
            unit = *found;
            by_size = from_zero_ = true;
            counts_days_ = unit == "d";
        }
    }
    bool by_clock = false;
    if (!seconds_per(unit)) {
        if (const auto found = unit_by_clock(text, layout, column)) {
            unit = *found;
            by_clock = true;
        }
    }
    const auto given = seconds_per(unit), answer = seconds_per(options.time_unit);
    unit_known_ = given.has_value() || options.time_unit_given;
    if (!unit_known_) note_unknown_unit(profile, options);
    if (!given && options.time_unit_given && options.time_unit != "s")
        notes_.push_back("The file names no unit of time: the times are assumed to be in " + options.time_unit +
                         ", the unit of the answer.");
    if (!given || !answer) return;
    if (by_size)
        notes_.push_back("Times count " + std::string(unit == "d" ? "days, as in spreadsheets" : unit + " since 1970") +
                         ", by their size; they count from the first one.");
    if (by_clock) notes_.push_back("Times count " + unit + ", by comparison with the clock in the file.");
    if (*given == *answer) return;
    factor_ = *given / *answer;
    notes_.push_back("Times are converted from " + unit + " to " + options.time_unit + ".");
}

// Asks for the unit if the numbers may be milliseconds or days but would be read as seconds; a usual spacing of seconds
// needs no question.
void TimeColumn::note_unknown_unit(const ColumnProfile& profile, const CsvOptions& options) {
    constexpr double kUsual = 5, kFast = 1e-3;
    if (profile.changes < 1 || !profile.rises || (profile.min_step < kUsual && profile.min_step >= kFast)) return;
    notes_.push_back("The file names no unit of time: the times are read as " + options.time_unit + ", " +
                     tunewright::text(profile.min_step) + " or more apart. Choose their unit if it is another.");
}

std::optional<TimeStamp> TimeColumn::stamp(std::string_view cell, std::string_view clock) const {
    auto now = read_time_stamp(cell, order_);
    if (now && short_is_minutes_ && is_short(*now, cell)) {
        now->seconds /= kMinute;
        now->minutes = true;
    }
    if (!now || clock.empty()) return now;
    const auto of_day = read_time_stamp(clock, order_);
    if (!of_day || of_day->has_date) return std::nullopt;
    now->seconds += of_day->seconds;
    now->has_clock = true;
    now->has_zone = of_day->has_zone;
    return now;
}

std::vector<std::string> TimeColumn::take_notes() {
    for (std::string& note : clock_.take_notes()) notes_.push_back(std::move(note));
    return std::move(notes_);
}

bool TimeColumn::read(std::string_view cell, std::string_view clock, int line, double& time) {
    if (stamps_) {
        const auto now = stamp(cell, clock);
        if (now) time = time_of(*now, line);
        return now.has_value();
    }
    double value = 0;
    if (!read_cell_number(cell, value, sign_, suffix_)) return false;
    if (!first_) first_ = value;
    time = (from_zero_ ? value - *first_ : value) * factor_;
    return true;
}

double TimeColumn::time_of(const TimeStamp& stamp, int line) {
    const double value = clock_.seconds(stamp, line);
    if (!first_) first_ = value, dated_ = stamp.has_date, zoned_ = stamp.has_zone;
    return (value - *first_) * factor_;
}

std::optional<double> TimeColumn::epoch() const {
    if (!first_ || (stamps_ && !dated_)) return std::nullopt;
    if (stamps_) return *first_;
    const double seconds = *first_ * factor_ * answer_s_, days = seconds / kDay;
    if (counts_days_) {
        if (!is_day(days)) return std::nullopt;
        return seconds - kDay * (days < kMatlabDayOf1970 / 2 ? kSpreadsheetDayOf1970 : kMatlabDayOf1970);
    }
    if (seconds < kFrom1970 || seconds > kTo1970) return std::nullopt;
    return from_zero_ ? seconds : 0;
}

}  // namespace tunewright::api
