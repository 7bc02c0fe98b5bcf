#include "engine/tuning/robust/scan.h"

#include <algorithm>
#include <cmath>

#include "engine/loop/stability.h"
#include "engine/tuning/robust/sqp.h"

namespace tunewright::robust {
namespace {

std::vector<double> spaced(double low, double high, int n) {
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) values.push_back(low * std::pow(high / low, n > 1 ? double(i) / (n - 1) : 0.5));
    return values;
}

/// A stable plant with an integral of the right sign is stable at low gain, so the first gap needs no count.
bool stable_at_low_gain(const LinearPlant& plant, double sign) {
    if (plant.integrators() != 0 || plant.unstable_poles() != 0) return false;
    for (const auto pole : plant.poles())
        if (pole.real() > -1e-9 * std::abs(pole)) return false;
    return sign * plant.low_frequency_gain() > 0;
}

bool first_gap_is_stable(const DesignProblem& problem) {
    if (problem.measured) return false;
    for (std::size_t i = 0; i < problem.plants(); ++i)
        if (!stable_at_low_gain(problem.plant_at(i), problem.sign)) return false;
    return true;
}

}  // namespace

std::vector<double> feasible_gains(const Sweep& sweep, double Ti, double Td) {
    const DesignProblem& problem = sweep.problem();
    const auto gaps = sweep.gain_gaps(Ti, Td);
    std::vector<double> gains;
    const bool first_is_stable = first_gap_is_stable(problem);
    for (std::size_t i = gaps.size(); i-- > 0;) {
        const GainGap& gap = gaps[i];
        if (!std::isfinite(gap.upper) || gap.upper <= gap.lower * (1 + 1e-9)) continue;
        const double middle = gap.lower > 0 ? std::sqrt(gap.lower * gap.upper) : 0.5 * gap.upper;
        const bool known = gap.lower == 0 && first_is_stable;
        if (!known && !is_stable(problem, {std::log(middle), std::log(Ti), problem.pid ? std::log(Td) : 0})) continue;
        gains.push_back(gap.upper * (1 - 1e-9));
        if (gap.lower > 0) gains.push_back(gap.lower * (1 + 1e-9));
    }
    return gains;
}

std::vector<ScanPoint> scan(const Sweep& sweep, const ScanBox& box) {
    const DesignProblem& problem = sweep.problem();
    const double unit = 1 / sweep.reference();
    std::vector<ScanPoint> found;
    const auto Td_values =
        problem.pid ? spaced(box.Td_low * unit, box.Td_high * unit, box.Td_points) : std::vector<double>{1.0};
    for (const double Ti : spaced(box.Ti_low * unit, box.Ti_high * unit, box.Ti_points))
        for (const double Td : Td_values) {
            const auto gains = feasible_gains(sweep, Ti, Td);
            if (gains.empty()) continue;
            const double Kp = *std::max_element(gains.begin(), gains.end());
            found.push_back({{std::log(Kp), std::log(Ti), problem.pid ? std::log(Td) : 0}, std::log(Ti / Kp)});
        }
    std::sort(found.begin(), found.end(), [](const ScanPoint& a, const ScanPoint& b) { return a.log_ie < b.log_ie; });
    return found;
}

}  // namespace tunewright::robust
