// The unknowns of the second level: Kp, Ti, with PID Td, with a free filter Tf, in this order.
#pragma once

#include <string>
#include <vector>

#include "engine/tuning/emulation/problem.h"

namespace tunewright::emulation {

using Point = std::vector<double>;

/// Their names, a bound and a coordinate of a Point for each.
std::vector<std::string> unknowns(const Problem& problem);

struct Bounds {
    Point low, high;
};

/// The controller at a point: b = 1, the filter derivative with PID.
Pid controller_at(const Problem& problem, const Point& point);

/// Its point; a PI of a PID problem has Td = 0.
Point point_of(const Problem& problem, const Pid& pid);

Point clipped(const Point& point, const Bounds& bounds);

}  // namespace tunewright::emulation
