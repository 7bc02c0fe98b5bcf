#include <algorithm>
#include <cctype>
#include <cmath>

#include "api/csv/columns/columns.h"
#include "api/csv/text.h"
#include "api/csv/time_stamp.h"

namespace tunewright::api {
namespace {

/// Hz of a unit of frequency; empty for another.
std::optional<double> hertz_per(std::string_view unit) {
    const std::string name = lower_case(trimmed(unit));
    if (name == "hz" || name == "1/s" || name == "s^-1" || name == "samples/s" || name == "sps") return 1;
    if (name == "khz") return 1e3;
    if (name == "mhz") return 1e6;
    return std::nullopt;
}

/// "fs = 100 Hz", "Sample Period:,5 Sec" without comment signs and quotes.
std::optional<FileSpacing> spacing_in(std::string_view line) {
    std::string plain;
    for (const char c : line)
        if (c != '"') plain += c;
    std::string_view rest =
        trimmed(std::string_view(plain).substr(std::min(plain.find_first_not_of("#%/* "), plain.size())));
    const std::size_t sign = rest.find_first_of("=:");
    if (sign == rest.npos) return std::nullopt;
    const Heading heading = split_heading(rest.substr(0, sign));
    FileSpacing out{is_frequency(heading), 0, heading.unit, std::string(trimmed(line))};
    if (!out.frequency && !is_spacing(heading)) return std::nullopt;
    rest = trimmed(rest.substr(sign + 1));
    rest = trimmed(rest.substr(std::min(rest.find_first_not_of("=:,;\t "), rest.size())));
    const std::size_t end = std::min(rest.find_first_not_of("0123456789.eE+-"), rest.size());
    if (!read_cell_number(rest.substr(0, end), out.value, DecimalSign::point) || !(out.value > 0)) return std::nullopt;
    const std::string_view unit = trimmed(rest.substr(end));
    if (!unit.empty() && (out.frequency ? hertz_per(unit) : seconds_per(unit))) out.unit = std::string(unit);
    return out;
}

}  // namespace

double spacing_of(const FileSpacing& spacing, const std::string& time_unit) {
    const auto answer = seconds_per(time_unit);
    if (spacing.frequency) return 1 / (spacing.value * hertz_per(spacing.unit).value_or(1)) / answer.value_or(1);
    const auto unit = seconds_per(spacing.unit);
    return spacing.value * (unit && answer ? *unit / *answer : 1);
}

std::optional<FileSpacing> spacing_above(std::string_view text, const CsvLayout& layout) {
    std::size_t at = 0;
    for (int number = 1; number < layout.data_line; ++number) {
        const auto line = next_line(text, at);
        if (!line) break;
        if (number == layout.heading_line) continue;
        if (auto found = spacing_in(*line)) return found;
    }
    return std::nullopt;
}

}  // namespace tunewright::api
