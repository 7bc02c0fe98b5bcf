// The numbers that a controller's program starts with, in seconds with the sign of the action as a separate setting.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "engine/controller/sampled/sampled_pid.h"

namespace tunewright::code {

/// Seconds in the unit that a label names: s, ms, min, h, d; nothing for any other label.
std::optional<double> seconds_in(const std::string& label);

/// The same law with its times in seconds; `seconds` is the length of its own time unit.
SampledPid in_seconds(SampledPid pid, double seconds);

/// Gains as a user of the program enters them.
struct Settings {
    bool ideal = true;    ///< Kp, Ti, Td; false where Kp is 0 or the signs differ: then Kp, Ki, Kd
    bool direct = false;  ///< true: direct action; the gains below have no sign
    double Kp = 0;
    double Ti = 0, Td = 0;  ///< of the ideal form; Ti = 0: no integral action
    double Ki = 0, Kd = 0;
};

/// Ti and Td are the shortest decimals from which Kp/Ti and Kp Td give these gains to the last bit, if such decimals
/// exist.
Settings settings_of(const ParallelPid& gains);

/// Tt of the anti-windup: sqrt(Ti Td), Ti without derivative action; empty for pure integral action, which has no such
/// time. Source: Åström and Hägglund, Advanced PID Control (2006), section 3.5.
std::optional<double> tracking_time(const ParallelPid& gains);

/// A tenth of the shorter of Ti and Td, at most the filter's Tf and at most `longest`, the longest that the loop
/// tolerates; rounded down to 1, 2 or 5 times a power of ten. Times in seconds. Empty if none of these times is known.
std::optional<double> proposed_sample_time(const ParallelPid& gains,
                                           double longest = std::numeric_limits<double>::infinity());

}  // namespace tunewright::code
