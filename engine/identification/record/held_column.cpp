#include "engine/identification/record/held_column.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tunewright {

HeldColumn held_column(const std::vector<double>& t, const std::vector<double>& values) {
    std::vector<std::pair<double, double>> known;
    for (std::size_t i = 0; i < std::min(t.size(), values.size()); ++i)
        if (std::isfinite(t[i]) && std::isfinite(values[i])) known.emplace_back(t[i], values[i]);
    std::ranges::stable_sort(known, {}, &std::pair<double, double>::first);
    HeldColumn out;
    for (const auto& [time, value] : known) {
        if (!out.empty() && out.value.back() == value) continue;
        out.time.push_back(time);
        out.value.push_back(value);
    }
    return out;
}

std::vector<double> at_samples(const HeldColumn& column, const CleanRecord& record) {
    constexpr double kTimeTolerance = 1e-9;  // of the record's length
    std::vector<double> out;
    if (column.empty()) return out;
    out.reserve(record.t.size());
    std::size_t at = 0;
    for (const double sample : record.t) {
        const double t = record.scale.t_origin + record.scale.t_scale * (sample + kTimeTolerance);
        while (at + 1 < column.time.size() && column.time[at + 1] <= t) ++at;
        out.push_back(column.value[at]);
    }
    return out;
}

}  // namespace tunewright
