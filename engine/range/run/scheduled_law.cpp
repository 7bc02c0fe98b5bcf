#include "engine/range/run/scheduled_law.h"

#include <cmath>

namespace tunewright::range {
namespace {

/// 1/Tt of the anti-windup: Tt = sqrt(Ti Td), Ti without derivative (Åström and Hägglund 2006, section 3.5).
double law_tracking_rate(const IdealPid& pid) { return 1 / (pid.Td > 0 ? std::sqrt(pid.Ti * pid.Td) : pid.Ti); }

bool filters(const IdealPid& pid) { return pid.filter.type != FilterType::none; }

}  // namespace

IdealPid ScheduledLaw::settings(double place) const {
    if (schedule_.interpolation == Interpolation::steps) return controller_of(schedule_.rows[row_]);
    return settings_at(schedule_, place);
}

void ScheduledLaw::begin_at(double place) {
    row_ = 0;
    while (row_ + 1 < schedule_.rows.size() && place >= schedule_.rows[row_ + 1].at) ++row_;
}

double ScheduledLaw::command(const IdealPid& pid, double r, double y, std::span<const double> s) const {
    if (!filters(pid)) return s[0] + pid.Kp * (r - y);
    return s[0] + pid.Kp * (r - s[1]) - pid.Kp * pid.Td / pid.filter.Tf * s[2];
}

void ScheduledLaw::rates(const IdealPid& pid, double r, double r_slope, double y, double excess,
                         std::span<const double> s, std::span<double> ds) const {
    const double seen = filters(pid) ? s[1] : y;
    ds[0] = pid.Kp / pid.Ti * (r - seen) - (1 - pid.b) * pid.Kp * r_slope + law_tracking_rate(pid) * excess;
    ds[1] = ds[2] = 0;
    if (!filters(pid)) return;
    const double Tf = pid.filter.Tf;
    ds[1] = s[2] / Tf;
    ds[2] = 2 * (y - s[1] - s[2]) / Tf;
}

}  // namespace tunewright::range
