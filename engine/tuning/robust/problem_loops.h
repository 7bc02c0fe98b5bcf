// The loops of a design problem: one controller on each plant, or on the measured points.
#pragma once

#include "engine/loop/measured_loop.h"
#include "engine/tuning/robust/design.h"

namespace tunewright::robust {

/// True if `test` holds for all of them; it is called with an Expected<Loop> or an Expected<MeasuredLoop>.
template <class Test>
bool holds_on_every_loop(const DesignProblem& problem, const ParallelPid& gains, Test test) {
    if (problem.measured != nullptr) return test(MeasuredLoop::make(*problem.measured, gains));
    for (std::size_t i = 0; i < problem.plants(); ++i)
        if (!test(Loop::make(problem.plant_at(i), gains))) return false;
    return true;
}

}  // namespace tunewright::robust
