// A controller with a plant that is known only at measured frequencies.
#pragma once

#include "engine/loop/frequency_loop.h"
#include "engine/plant/frequency_response.h"

namespace tunewright {

/// Everything is computed within the measured band. Above it |L| is assumed to decrease, so that its end value, at the
/// worst phase, is a bound; below it the plant is assumed to be its static gain with its integrators.
class MeasuredLoop {
public:
    /// Errors: those of check_controller; unsupported ("controller") where |L| at the band's end is above
    /// kMaxModulusAtEnd, because the loop is then not determined by the measured band.
    static Expected<MeasuredLoop> make(const MeasuredPlant& plant, const ParallelPid& gains);

    LoopPoint at(double omega) const;

    static LoopGrid ends() { return {}; }       ///< the band's own ends are on its grid
    static double turning_time() { return 0; }  ///< the grid follows every turn
    static constexpr double kMaxModulusAtEnd = 0.5;

    const MeasuredPlant& plant() const { return *plant_; }
    const ParallelPid& gains() const { return gains_; }

private:
    MeasuredLoop(const MeasuredPlant& plant, const ParallelPid& gains) : plant_(&plant), gains_(gains) {}

    const MeasuredPlant* plant_;
    ParallelPid gains_;
};

/// The band's points, with more between them where L turns fast.
LoopGrid make_loop_grid(const MeasuredLoop& loop);

/// Nyquist's criterion with the plant's unstable poles and integrators.
StabilityCount count_unstable_poles(const MeasuredLoop& loop);

}  // namespace tunewright
