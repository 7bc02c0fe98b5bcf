#include "api/csv/shape/held_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tunewright::api {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Takes `value` as the current one; true if it is a number other than the previous one.
bool moves(double value, double& held) {
    if (std::isnan(value) || value == held) return false;
    held = value;
    return true;
}

}  // namespace

bool hold_reference(std::vector<double>& r) {
    const auto known = std::ranges::find_if(r, [](double value) { return !std::isnan(value); });
    if (known == r.end()) {
        r.clear();
        return false;
    }
    double last = *known;
    for (double& value : r) last = value = std::isnan(value) ? last : value;
    return true;
}

void hold_input(CsvRecord& record) {
    double u = kNoNumber;
    std::vector<double> d(record.d.size(), kNoNumber);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < record.t.size(); ++i) {
        bool moved = moves(record.u[i], u);
        for (std::size_t k = 0; k < d.size(); ++k) moved = moves(record.d[k].values[i], d[k]) || moved;
        if (std::isnan(record.y[i]) && !moved) continue;
        record.t[kept] = record.t[i];
        record.u[kept] = u;
        record.y[kept] = record.y[i];
        if (!record.r.empty()) record.r[kept] = record.r[i];
        if (!record.automatic.empty()) record.automatic[kept] = record.automatic[i];
        for (FurtherInput& input : record.d) input.values[kept] = input.values[i];
        record.lines[kept++] = record.lines[i];
    }
    for (auto* column : {&record.t, &record.u, &record.y}) column->resize(kept);
    if (!record.r.empty()) record.r.resize(kept);
    if (!record.automatic.empty()) record.automatic.resize(kept);
    for (FurtherInput& input : record.d) input.values.resize(kept);
    record.lines.resize(kept);
}

}  // namespace tunewright::api
