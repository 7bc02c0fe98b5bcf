#include <algorithm>
#include <cmath>

#include "api/contract/record.h"

namespace tunewright::api {
namespace {

/// True if `d` is a + b x within rounding, with b other than 0, in the rows where both have numbers; NaN repeats the
/// number before it.
bool moves_as(const std::vector<double>& d, const std::vector<double>& x) {
    constexpr double kRounding = 1e-9;  // of the range of d
    std::vector<std::pair<double, double>> held;
    double last_d = std::nan(""), last_x = last_d;
    for (std::size_t i = 0; i < d.size(); ++i) {
        if (!std::isnan(d[i])) last_d = d[i];
        if (!std::isnan(x[i])) last_x = x[i];
        if (!std::isnan(last_d) && !std::isnan(last_x)) held.emplace_back(last_x, last_d);
    }
    if (held.empty()) return false;
    const auto [x0, d0] = held.front();
    const auto by = [&](auto member) {
        return std::ranges::max_element(
            held, {}, [&, first = held.front().*member](const auto& row) { return std::abs(row.*member - first); });
    };
    const auto farthest = by(&std::pair<double, double>::first);
    const double range_x = farthest->first - x0,
                 range_d = std::abs(by(&std::pair<double, double>::second)->second - d0);
    if (range_x == 0 || range_d == 0) return false;
    const double slope = (farthest->second - d0) / range_x;
    return std::ranges::all_of(held, [&, x0 = x0, d0 = d0](const auto& row) {
        return std::abs(row.second - d0 - slope * (row.first - x0)) <= kRounding * range_d;
    });
}

/// "u", "y" or the name of an earlier disturbance that moves as number `k` does; "" for none.
std::string twin_of(const Record& record, std::size_t k) {
    const std::vector<double>& d = record.d[k].values;
    if (moves_as(d, record.u)) return "u";
    if (moves_as(d, record.y)) return "y";
    for (std::size_t i = 0; i < k; ++i)
        if (moves_as(d, record.d[i].values)) return "\"" + record.d[i].name + "\"";
    return "";
}

}  // namespace

void check_disturbances(const Record& record, bool from_csv, Reader& reader) {
    if (record.d.empty()) return;
    for (std::size_t k = 0; k < record.d.size(); ++k) {
        if (record.d[k].values.size() != record.u.size() || record.y.size() != record.u.size()) return;
        const std::string twin = twin_of(record, k);
        if (twin.empty()) continue;
        reader.fault_below((from_csv ? "columns/d/" : "d/") + std::to_string(k), 0,
                           "\"" + record.d[k].name + "\" moves as " + twin +
                               " does in every row: what each of them does to y cannot be separated. Leave it out.");
    }
}

}  // namespace tunewright::api
