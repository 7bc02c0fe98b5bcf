// Settings that stop the cycle of a sticking valve until it is repaired, and what each costs.
//
// 1. The plant behind the valve is fitted (valve_plant), for valves of about the size of the verdict.
// 2. Today's PI law, valve and plant are simulated at the record's rate. Those that do not make the recorded cycle are
//    left out; if none makes it, nothing can be told.
// 3. Three means are searched, each with today's gain and lower ones: a longer integral time, a gap on the error within
//    which the integral rests, and no integral action. A setting counts if the output comes to rest with every valve
//    and plant of step 2, begun in several phases of the cycle and with several steps of the load.
// 4. Of each means the one that costs least is answered.
#pragma once

#include <array>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/check/loop_check.h"
#include "engine/plant/plant.h"

namespace tunewright::check {

enum class StopMeans { integral_time, gap, no_integral };

struct CycleStop {
    StopMeans means = StopMeans::integral_time;
    double Kp = 0;
    std::optional<double> Ti;  ///< time; empty: no integral action
    double gap = 0;            ///< y: the integral rests while abs e is at most this
    /// Mean abs e over kCostPeriods of the cycle after a step of the load of one band, over that of today's settings,
    /// both without the fault of the valve: least and largest over the plants that make the recorded cycle.
    std::array<double, 2> error_ratio{};
    double standing_error = 0;  ///< largest abs e at rest, with the fault, after steps of the load up to one band; y
    std::string detail;         ///< one sentence
};
inline constexpr double kCostPeriods = 5;

struct CycleStops {
    enum class Outcome {
        found,    ///< `stops` has at least one
        none,     ///< no setting of the search stops the cycle
        not_told  ///< the simulated loop does not make the recorded cycle, or something that it needs is not known
    };
    Outcome outcome = Outcome::not_told;
    std::vector<CycleStop> stops;   ///< in the order of StopMeans
    std::optional<Fopdt> plant;     ///< behind the valve
    Figure period, amplitude;       ///< of the simulated cycle, time and y
    double recorded_amplitude = 0;  ///< sqrt 2 times the standard deviation without what is slower than the cycle, y
    std::string detail;             ///< one sentence
};

/// `check`: that of the question, with a sticking valve or a backlash as cause.
CycleStops cycle_stops(const LoopQuestion& question, const LoopCheck& check, const std::stop_token& stop);

}  // namespace tunewright::check
