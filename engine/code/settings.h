// The numbers that a controller's program starts with, in seconds and with the sign of the action apart.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "engine/controller/sampled/sampled_pid.h"

namespace tunewright::code {

/// Seconds in the unit that a label names: s, ms, min, h, d; nothing for any other label.
std::optional<double> seconds_in(const std::string& label);

/// The same law with its time in seconds; `seconds` is what its own unit of time has.
SampledPid in_seconds(SampledPid pid, double seconds);

/// Gains as a user of the program sets them.
struct Settings {
    bool ideal = true;    ///< Kp, Ti, Td; false where Kp is 0 or the signs differ: then Kp, Ki, Kd
    bool direct = false;  ///< the action, which is the sign that all gains below have been freed of
    double Kp = 0;
    double Ti = 0, Td = 0;  ///< of the ideal form; Ti = 0: no integral action
    double Ki = 0, Kd = 0;
};

/// Ti and Td are the shortest decimals from which Kp/Ti and Kp Td give these gains to the last bit, where there are.
Settings settings_of(const ParallelPid& gains);

/// Tt of the anti-windup: sqrt(Ti Td), Ti without derivative action; nothing for pure integral action, which has no
/// time of its own. Source: Astrom and Hagglund, Advanced PID Control (2006), section 3.5.
std::optional<double> tracking_time(const ParallelPid& gains);

/// A tenth of the shorter of Ti and Td, and no more than the filter's Tf and `longest`, what the loop bears, as the
/// next 1, 2 or 5 times a power of ten below. Times in seconds. Nothing where none of these times is known.
std::optional<double> proposed_sample_time(const ParallelPid& gains,
                                           double longest = std::numeric_limits<double>::infinity());

}  // namespace tunewright::code
