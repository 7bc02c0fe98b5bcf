#include "engine/controller/schedule/schedule.h"

#include <algorithm>

namespace tunewright {
namespace {

double mixed(double left, double right, double share) { return left + share * (right - left); }

}  // namespace

std::string_view to_string(Interpolation interpolation) {
    switch (interpolation) {
        case Interpolation::steps: return "steps";
        case Interpolation::linear_in_gains: return "linear_in_gains";
        case Interpolation::linear_in_times: return "linear_in_times";
    }
    return "steps";
}

IdealPid controller_of(const ScheduleRow& row) {
    IdealPid pid{.Kp = row.Kp, .Ti = row.Ti, .Td = row.Td, .b = row.b};
    if (row.Tf > 0) pid.filter = {FilterType::measurement_second_order, row.Tf};
    return pid;
}

IdealPid settings_at(const Schedule& schedule, double at) {
    const auto& rows = schedule.rows;
    const auto after =
        std::upper_bound(rows.begin(), rows.end(), at, [](double x, const ScheduleRow& row) { return x < row.at; });
    if (after == rows.begin()) return controller_of(rows.front());
    const ScheduleRow& left = *(after - 1);
    if (after == rows.end() || schedule.interpolation == Interpolation::steps) return controller_of(left);
    const double share = (at - left.at) / (after->at - left.at);
    const bool by_rate = schedule.interpolation == Interpolation::linear_in_gains;
    return controller_of(
        {.at = at,
         .Kp = mixed(left.Kp, after->Kp, share),
         .Ti = by_rate ? 1 / mixed(1 / left.Ti, 1 / after->Ti, share) : mixed(left.Ti, after->Ti, share),
         .Td = mixed(left.Td, after->Td, share),
         .Tf = mixed(left.Tf, after->Tf, share),
         .b = mixed(left.b, after->b, share)});
}

std::size_t row_after(const Schedule& schedule, std::size_t row, double at) {
    const double half = 0.5 * schedule.hysteresis;
    while (row + 1 < schedule.rows.size() && at > schedule.rows[row + 1].at + half) ++row;
    while (row > 0 && at < schedule.rows[row].at - half) --row;
    return row;
}

}  // namespace tunewright
