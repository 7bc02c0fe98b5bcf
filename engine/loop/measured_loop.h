// A controller with a plant that is known only at measured frequencies.
#pragma once

#include <vector>

#include "engine/loop/margins.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/plant/frequency_response.h"

namespace tunewright {

/// Everything is computed within the measured band. Above it |L| is assumed to decrease, so that its end value, at the
/// worst phase, is a bound; below it the plant is assumed to be its static gain with its integrators.
class MeasuredLoop {
public:
    /// Errors: those of check_controller.
    static Expected<MeasuredLoop> make(const MeasuredPlant& plant, const ParallelPid& gains);

    LoopPoint at(double omega) const;

    /// The reason why the band is too short, in words: |L| at its end is above kLargestEnd. Empty: it is long enough.
    std::optional<std::string> band_too_short() const;
    static constexpr double kLargestEnd = 0.5;

    /// Nyquist's criterion with the plant's unstable poles and integrators; valid if the band is not too short.
    StabilityCount count_unstable_poles() const;

    /// Within the band; the maximum may be at either end.
    Peaks peaks() const;
    Margins margins() const;

    /// The band's points, with more between them where L turns fast.
    const std::vector<double>& omega() const { return omega_; }
    LoopGrid grid() const;  ///< the loop at these frequencies

private:
    MeasuredLoop(const MeasuredPlant& plant, const ParallelPid& gains);

    const MeasuredPlant* plant_;
    ParallelPid gains_;
    std::vector<double> omega_;
};

}  // namespace tunewright
