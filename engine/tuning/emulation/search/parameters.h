// The unknowns of the second level: Kp, Ti, with PID Td, with a free filter Tf, in this order.
#pragma once

#include <string>
#include <vector>

#include "engine/tuning/emulation/problem.h"

namespace tunewright::emulation {

using SettingsPoint = std::vector<double>;

/// Their names, a bound and a coordinate of a Point for each.
std::vector<std::string> unknowns(const EmulationProblem& problem);

struct Bounds {
    SettingsPoint low, high;
};

/// The controller at a point: b = 1, the filter derivative with PID.
Pid controller_at(const EmulationProblem& problem, const SettingsPoint& point);

/// Its point; a PI of a PID problem has Td = 0.
SettingsPoint point_of(const EmulationProblem& problem, const Pid& pid);

SettingsPoint clipped(const SettingsPoint& point, const Bounds& bounds);

}  // namespace tunewright::emulation
