// Cures are tried on the entry's loop before they are suggested: no figure here is estimated. Each is computed only if
// its finding is made, and is empty if the request was stopped.
#pragma once

#include <optional>

#include "engine/request/verdict/findings.h"
#include "engine/tuning/method/setpoint.h"

namespace tunewright::verdict {

/// A lower b or a set-point lag with which the implemented loop overshoots by at most `percent` after a set-point step,
/// with its sampled law and the actuator's limits. Empty: unknown, or there is none; always empty for equations and for
/// a nonlinear integral.
std::optional<SetpointCure> overshoot_cure(const VerdictInput& c, double percent);

/// The shortest duration of a ramp of the set point with which the implemented loop overshoots by at most `percent`.
/// Empty as above, and with limits of u.
std::optional<double> overshoot_ramp(const VerdictInput& c, double percent);

/// The least load IAE that any controller can have, in y times time: the load has moved y for one dead time before the
/// first reaction to it arrives, so it is at least |d| |integral of h from 0 to L| with h the step response of the
/// plant without its dead time. Linear plants without a horizon; else empty.
std::optional<double> min_load_IAE(const VerdictInput& c);

struct FilteredPeaks {
    double Ms = 0, Mks = 0;
};

/// The entry's gains with another filter, on the nominal linear plant. Empty where that loop is unstable, or for
/// equations.
std::optional<FilteredPeaks> peaks_with_filter(const VerdictInput& c, const Filter& filter);

/// True if |C S| peaks at a higher frequency than |S|: at lower frequencies u must hold y, such as 1/K at rest, and
/// noise is not the cause. True for a plant known by points alone.
bool noise_gain_peaks_beyond(const VerdictInput& c);

struct OtherDesign {
    Figure load_IAE;
    double Mks = 0;
};

/// The method robust once more, with the entry's options and this filter time. Empty if the entry is not such a design
/// (for the load IAE, one linear plant, the ideal law), or if there is none.
std::optional<OtherDesign> designed_with_filter(const VerdictInput& c, double Tf);

}  // namespace tunewright::verdict
