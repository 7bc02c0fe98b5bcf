// A controller around a plant that is known at measured frequencies alone.
#pragma once

#include <vector>

#include "engine/loop/margins.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/plant/frequency_response.h"

namespace tunewright {

/// Everything is computed within the measured band. Above it |L| is taken to fall, so that its end value, at worst
/// phase, bounds what follows; below it the plant is taken to be its static gain with its integrators.
class MeasuredLoop {
public:
    /// Errors: those of check_controller.
    static Expected<MeasuredLoop> make(const MeasuredPlant& plant, const ParallelPid& gains);

    LoopPoint at(double omega) const;

    /// Why the band does not hold all that matters, in words: |L| at its end above kLargestEnd. Empty: it does.
    std::optional<std::string> band_too_short() const;
    static constexpr double kLargestEnd = 0.5;

    /// Nyquist's criterion with the plant's unstable poles and integrators; meaningful where the band is not too short.
    StabilityCount count_unstable_poles() const;

    /// Within the band; both ends may hold the maximum.
    Peaks peaks() const;
    Margins margins() const;

    /// The band's points, with more between them where L turns fast.
    const std::vector<double>& omega() const { return omega_; }
    LoopGrid grid() const;  ///< the loop at these

private:
    MeasuredLoop(const MeasuredPlant& plant, const ParallelPid& gains);

    const MeasuredPlant* plant_;
    ParallelPid gains_;
    std::vector<double> omega_;
};

}  // namespace tunewright
