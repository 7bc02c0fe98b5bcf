#include "engine/tuning/emulation/search/parameters.h"

#include <algorithm>

namespace tunewright::emulation {

std::vector<std::string> unknowns(const EmulationProblem& problem) {
    std::vector<std::string> names = {"Kp", "Ti"};
    if (problem.with_derivative) names.emplace_back("Td");
    if (problem.free_Tf()) names.emplace_back("Tf");
    return names;
}

Pid controller_at(const EmulationProblem& problem, const SettingsPoint& point) {
    Pid pid{.Kp = point[0], .Ti = point[1]};
    if (!problem.with_derivative) return pid;
    pid.Td = point[2];
    pid.c = problem.error_derivative ? 1 : 0;
    pid.filter = {FilterType::derivative, problem.free_Tf() ? point[3] : problem.Tf};
    return pid;
}

SettingsPoint point_of(const EmulationProblem& problem, const Pid& pid) {
    SettingsPoint point = {pid.Kp, pid.Ti};
    if (problem.with_derivative) point.push_back(pid.Td);
    if (problem.free_Tf()) point.push_back(pid.filter.Tf > 0 ? pid.filter.Tf : problem.Tf);
    return point;
}

SettingsPoint clipped(const SettingsPoint& point, const Bounds& bounds) {
    SettingsPoint inside = point;
    for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = std::clamp(inside[i], bounds.low[i], bounds.high[i]);
    return inside;
}

}  // namespace tunewright::emulation
