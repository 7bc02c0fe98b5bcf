#include "api/csv/columns/column_profile.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "api/csv/columns/loop_mode.h"
#include "api/csv/time_stamp.h"

namespace tunewright::api {
namespace {

void look_at(std::string_view cell, DecimalSign sign, double& last, ColumnProfile& profile) {
    if (is_missing(cell)) {
        ++profile.missing;
        return;
    }
    double value = 0;
    if (profile.numbers == 0) profile.suffix = std::string(unit_suffix(cell));
    if (!is_compact_stamp(cell) && read_cell_number(cell, value, sign, profile.suffix)) {
        if (profile.numbers > 0) {
            profile.changes += value != last ? 1 : 0;
            profile.rises = profile.rises && value > last;
            profile.falls += value < last ? 1 : 0;
            const double step = value - last;
            profile.min_step = profile.numbers == 1 ? step : std::min(profile.min_step, step);
            profile.largest_step = profile.numbers == 1 ? step : std::max(profile.largest_step, step);
        } else {
            profile.first = value;
        }
        last = value;
        ++profile.numbers;
    } else if (const auto level = switch_word(cell)) {
        if (profile.switches++ > 0) profile.changes += *level != last ? 1 : 0;
        last = *level;
    } else if (const auto stamp = read_time_stamp(cell)) {
        ++profile.stamps;
        profile.dates += stamp->has_clock ? 0 : 1;
        profile.clocks += stamp->has_date ? 0 : 1;
    } else {
        profile.modes += mode_word(cell).has_value() ? 1 : 0;
        if (profile.texts++ == 0)
            profile.first_text = std::string(cell);
        else
            profile.text_changes += cell != profile.first_text ? 1 : 0;
    }
}

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

bool run_apart(std::string_view text, const CsvLayout& layout, std::size_t one, std::size_t other) {
    constexpr int kProbedLines = 500;
    constexpr double kEqualTolerance = 1e-3, kMaxShareApart = 0.05;
    CsvLines lines(text, layout);
    CsvLine line;
    std::optional<double> usual;
    int both = 0, apart = 0;
    for (int n = 0; n < kProbedLines && lines.next(line); ++n) {
        double at[2] = {};
        bool read = std::max(one, other) < line.cells.size();
        for (std::size_t k = 0; read && k < 2; ++k) {
            const std::string_view cell = line.cells[k == 0 ? one : other];
            const auto stamp = read_time_stamp(cell);
            if (stamp) at[k] = stamp->seconds;
            read = stamp || read_cell_number(cell, at[k], layout.sign);
        }
        if (!read) continue;
        ++both;
        const double distance = at[1] - at[0];
        if (!usual) usual = distance;
        apart += std::abs(distance - *usual) > kEqualTolerance ? 1 : 0;
    }
    return apart > kMaxShareApart * both;
}

}  // namespace tunewright::api
