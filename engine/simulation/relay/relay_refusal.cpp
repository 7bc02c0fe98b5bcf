#include "engine/simulation/relay/relay_refusal.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"

namespace tunewright {
namespace {

Error refuse(const char* where, std::string message) {
    return {ErrorKind::invalid_argument, where, std::move(message)};
}

Error latched_at_rest(const EndedRun& run) {
    const bool high = run.u == run.levels.u_plus;
    const std::string level = high ? "u_plus" : "u_minus";
    const std::string rest = "With u at " + level + " = " + text(run.u) +
                             " the plant comes to rest at y = " + text(run.direction * run.y) +
                             ", and the relay does not switch";
    const bool right_side = high ? run.y > 0 : run.y < 0;
    if (right_side)
        return refuse("relay/hysteresis", rest + " before y leaves the hysteresis " + text(run.levels.hysteresis) +
                                              ". Lower the hysteresis below " + text(0.8 * std::abs(run.y)) +
                                              ", or raise the relay's levels.");
    const char* side = (run.direction > 0) == high ? "above" : "below";
    return refuse(high ? "relay/u_plus" : "relay/u_minus",
                  rest + ": it waits for y " + side +
                      " the hysteresis. u_plus and u_minus must be on both sides of 0, " + "the operating point.");
}

Error ramps_away(const EndedRun& run) {
    const bool high = run.u == run.levels.u_plus;
    return refuse(high ? "relay/u_plus" : "relay/u_minus",
                  std::string(high ? "u_plus" : "u_minus") + " is " + text(run.u) +
                      "; on an integrating plant u_plus must be > 0 and u_minus < 0, or y moves away and the relay "
                      "never switches back.");
}

// y grows from the hysteresis for one dead time with the wrong level; the other level must then still be able to
// reverse it. For K e^(-Ls)/(T s + 1), T < 0: e^(L/|T|) (eps + |K| u) < |K| (u_plus - u_minus), either side.
Error first_order_escape(const EndedRun& run) {
    const double T = 1 / run.plant.poles()[0].real();
    const double K = std::abs(run.plant.low_frequency_gain());
    const double swing = K * (run.levels.u_plus - run.levels.u_minus);
    const double worse = K * std::max(run.levels.u_plus, -run.levels.u_minus) + run.levels.hysteresis;
    const double limit = std::log(std::max(swing / worse, 1.0));
    return {ErrorKind::unsupported, "plant/L",
            "y is unbounded: L/|T| is " + text(run.plant.dead_time() / T) +
                ", and this relay can reverse y only for L/|T| < " + text(limit) +
                " (ln 2 = 0.693 for a symmetric relay without hysteresis). A smaller hysteresis" +
                " and levels of equal size extend the range up to ln 2; beyond it no relay test is possible."};
}

}  // namespace

Error no_oscillation(const EndedRun& run) {
    const LinearPlant& plant = run.plant;
    switch (run.end) {
        case RelayEnd::latched: return plant.integrators() > 0 ? ramps_away(run) : latched_at_rest(run);
        case RelayEnd::escaped:
            if (plant.poles().size() == 1 && plant.zeros().empty() && plant.integrators() == 0 &&
                plant.unstable_poles() == 1)
                return first_order_escape(run);
            return {ErrorKind::unsupported, "plant",
                    "y is unbounded: this relay cannot stabilise the plant. A smaller hysteresis or larger levels may "
                    "help; an unstable plant with a slow response cannot be tested with a relay at all."};
        case RelayEnd::too_fast:
            return refuse("relay/hysteresis", "hysteresis is " + text(run.levels.hysteresis) +
                                                  "; the relay then switches infinitely fast. Make it larger than the "
                                                  "jump of y at a switch, or set relay_sample_time > 0.");
        case RelayEnd::exhausted:
        case RelayEnd::running: break;
    }
    return {ErrorKind::unsupported, "plant",
            "The plant's modes have too different time scales for an event-accurate run: the oscillation was not "
            "reached within the allowed number of steps. Omit the fastest modes, or set relay_sample_time > 0."};
}

Error no_steady_cycle(const LinearPlant& plant, int cycles) {
    std::string cause = "Its switches do not repeat after two, because several oscillations of the plant compete.";
    if (plant.integrators() >= 2)
        cause = "The oscillation of a double integrator without damping grows with a relay.";
    else if (!RelayMotion(plant, 1).bounded())
        cause = "Its oscillation grows, or does not repeat with two switches per period.";
    return {ErrorKind::unsupported, "plant",
            "After " + std::to_string(cycles) + " cycles the oscillation is still not steady. " + cause +
                " Try another hysteresis or other levels."};
}

std::optional<Error> switches_without_end(const LinearPlant& plant, const RelayLevels& levels, double direction) {
    const int excess = plant.pole_excess();
    if (plant.dead_time() > 0 || levels.hysteresis > 0 || excess > 2) return std::nullopt;
    if (direction * plant.gain() < 0) return std::nullopt;
    return refuse("relay/hysteresis",
                  "hysteresis is 0; without dead time a relay on this plant (" + std::to_string(excess) +
                      " more poles than zeros) switches infinitely fast. Give hysteresis > 0, or set relay_sample_time "
                      "> 0.");
}

}  // namespace tunewright
