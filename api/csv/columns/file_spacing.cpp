#include "api/csv/columns/file_spacing.h"

#include <algorithm>

#include "api/csv/columns/column_facts.h"
#include "api/csv/columns/heading.h"
#include "api/csv/columns/heading_words.h"
#include "api/csv/record_notes.h"
#include "api/csv/text.h"
#include "api/csv/time_stamp.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

/// Hz of a unit of frequency ("kHz", "1/min", "samples per second", "s^-1"); empty for another unit.
std::optional<double> hertz_per(std::string_view text) {
    static constexpr std::string_view kCounted[] = {"",     "1",       "s",        "sa",     "sample", "samples",
                                                    "rows", "reading", "readings", "points", "pts",    "times"};
    const std::string unit = lower_case(trimmed(text));
    if (unit == "hz" || unit == "sps") return 1;
    if (unit == "khz") return 1e3;
    if (text == "MHz") return 1e6;
    if (text == "mHz") return 1e-3;
    if (unit.ends_with("^-1")) {
        const auto seconds = seconds_per(unit.substr(0, unit.size() - 3));
        return seconds ? std::optional(1 / *seconds) : std::nullopt;
    }
    const bool slash = unit.find('/') != unit.npos;
    const std::string_view whole = unit, between = slash ? "/" : "per ";
    const std::size_t at = whole.find(between);
    if (at == whole.npos) return std::nullopt;
    const auto seconds = seconds_per(trimmed(whole.substr(at + between.size())));
    if (!seconds || !is_one_of(trimmed(whole.substr(0, at)), kCounted)) return std::nullopt;
    return 1 / *seconds;
}

/// A period or a frequency, according to `unit`; without a unit, according to the heading, and a frequency is then in
/// Hz. Empty if the unit is unknown.
std::optional<FileSpacing> spacing_from(double value, std::string_view unit, bool frequency, std::string text) {
    if (!(value > 0)) return std::nullopt;
    if (unit.empty()) return FileSpacing{frequency ? 1 / value : value, std::nullopt, frequency, std::move(text)};
    if (const auto hertz = hertz_per(unit)) return FileSpacing{1 / (value * *hertz), 1, true, std::move(text)};
    if (const auto seconds = seconds_per(unit)) return FileSpacing{value, *seconds, false, std::move(text)};
    return std::nullopt;
}

/// The first cell behind the number that is not blank: spreadsheets pad a line with separators, or put the unit in a
/// cell of its own.
std::string_view unit_behind(std::string_view rest) {
    constexpr std::string_view kSeparators = ",;|\t";
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find_first_of(kSeparators), rest.size());
        if (const std::string_view cell = trimmed(rest.substr(0, end)); !cell.empty()) return cell;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return {};
}

/// Reads "fs = 100 Hz" and "Sample Period:,5 Sec", without comment signs and quotes.
std::optional<FileSpacing> spacing_in(std::string_view line, const CsvLayout& layout) {
    std::string plain;
    for (const char c : line)
        if (c != '"') plain += c;
    std::string_view rest =
        trimmed(std::string_view(plain).substr(std::min(plain.find_first_not_of("#%/* "), plain.size())));
    const std::size_t sign = rest.find_first_of("=:");
    if (sign == rest.npos) return std::nullopt;
    const Heading heading = split_heading(rest.substr(0, sign));
    if (!is_frequency(heading) && !is_spacing(heading)) return std::nullopt;
    rest.remove_prefix(std::min(rest.find_first_not_of("=:,;\t ", sign), rest.size()));
    // A comma that separates cells ends the number.
    const bool commas = layout.sign == DecimalSign::comma || layout.separator != ',';
    std::size_t end = std::min(rest.find_first_not_of(commas ? "0123456789.eE+-," : "0123456789.eE+-"), rest.size());
    while (end > 0 && rest[end - 1] == ',') --end;
    double value = 0;
    if (!read_cell_number(rest.substr(0, end), value, layout.sign)) return std::nullopt;
    const std::string_view unit = unit_behind(rest.substr(end));
    if (!unit.empty() && is_digit(unit.front())) return std::nullopt;
    return spacing_from(value, unit.empty() ? heading.unit : unit, is_frequency(heading), std::string(trimmed(line)));
}

}  // namespace

double spacing_of(const FileSpacing& spacing, const CsvOptions& options) {
    const double answer = seconds_per(options.time_unit).value_or(1);
    if (spacing.seconds_per_unit) return spacing.rows_apart * *spacing.seconds_per_unit / answer;
    if (spacing.frequency) return spacing.rows_apart / answer;
    const auto given = seconds_per(options.file_time_unit);
    return given ? spacing.rows_apart * *given / answer : spacing.rows_apart;
}

bool unit_is_known(const FileSpacing& spacing, const CsvOptions& options) {
    return spacing.seconds_per_unit || options.time_unit_given || !options.file_time_unit.empty();
}

std::string spacing_note(const FileSpacing& spacing, const CsvOptions& options) {
    return spacing.text +
           (spacing.frequency ? " gives the sampling frequency: a row every "
                              : " gives the sample time: a row every ") +
           tunewright::text(spacing_of(spacing, options)) + " " + options.time_unit + ".";
}

std::optional<FileSpacing> spacing_above(std::string_view text, const CsvLayout& layout) {
    std::size_t at = 0;
    for (int number = 1; number < layout.data_line; ++number) {
        const auto line = next_line(text, at);
        if (!line) break;
        if (number == layout.heading_line) continue;
        if (auto found = spacing_in(*line, layout)) {
            found->text = "The line " + in_quotes(found->text) + " above the data";
            return found;
        }
    }
    return std::nullopt;
}

std::optional<FileSpacing> spacing_in_column(const ColumnFacts& facts, std::size_t column) {
    const Heading& heading = facts.heading(column);
    const ColumnProfile& p = facts.profile(column);
    const bool constant = p.numbers != 2 && p.changes == 0 && p.texts == 0;
    if (!constant || (!is_spacing(heading) && !is_frequency(heading))) return std::nullopt;
    const std::string unit = unit_of(facts.layout(), p, column), text = "Column " + facts.shown(column);
    auto found = spacing_from(p.first, unit, is_frequency(heading), text);
    // The line below the headings may hold descriptions instead of units.
    if (!found && heading.unit.empty() && p.suffix.empty())
        found = spacing_from(p.first, "", is_frequency(heading), text);
    return found;
}

}  // namespace tunewright::api
