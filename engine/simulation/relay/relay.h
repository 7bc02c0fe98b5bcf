// A relay test on a linear plant: what it would show, and the plan of a good one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/plant.h"
#include "engine/progress.h"
#include "engine/simulation/relay/limit_cycle.h"
#include "engine/warning.h"

namespace tunewright {

/// From rest, u = u_plus at t = 0; e = -y: to u_minus when y > hysteresis, to u_plus when y < -hysteresis. Where the
/// feedback must be positive for that (RelayExperiment::reversed) the relay acts on -y instead.
struct RelaySettings {
    double u_plus = 1, u_minus = -1;  ///< u_minus < u_plus; deviations from the operating point
    double hysteresis = 0;            ///< >= 0; y
    double noise_std = 0;             ///< >= 0; of white noise on each sample of y, seen by the relay; y
    double relay_sample_time = 0;     ///< 0: switches at the instant of crossing; else the relay looks that often
    /// Spacing of the record's rows; a whole multiple of relay_sample_time if that is not 0. None: Pu/200, or
    /// relay_sample_time; more where the record would have more than kMaxRelayRows.
    std::optional<double> record_interval;
    int cycles = 10;              ///< 1 to 1000 cycles of u_plus and u_minus from t = 0
    int seed = 0;                 ///< of the noise; >= 0
    std::optional<double> shift;  ///< sigma of the limit cycle's shifted point, > 0; none: 1/Pu
};

/// u[i] holds from t[i]. Rows every record_interval and at every switch; the last row is the switch that ends the last
/// cycle.
struct RelayRecord {
    std::vector<double> t, u, y;
};

/// The relay test worth making on this plant. With noise: a hysteresis of 3 noise_std, which a single white sample
/// exceeds by chance once in 741, and levels, raised in their proportion where needed, that swing y over 3 hystereses
/// to either side; 10 steady cycles for averaging (the error falls with the root of their number). Without: levels and
/// hysteresis as given and 3 steady cycles. Rows 1, 2 or 5 times a power of ten apart, at least 200 a period, or as
/// many whole samples of a sampled relay.
struct RelayPlan {
    double u_plus = 0, u_minus = 0;
    double hysteresis = 0;
    double amplitude = 0;        ///< half of y's swing that follows; y
    double expected_period = 0;  ///< time
    int cycles = 0;              ///< those to settle included
    double duration = 0;         ///< time
    double record_interval = 0;  ///< time
    std::string reason;          ///< why these
};

struct RelayExperiment {
    RelayRecord record;
    LimitCycle limit_cycle;  ///< the steady one, without noise
    bool reversed = false;   ///< the relay acts on -y
    RelayPlan plan;
    std::vector<Warning> warnings;
};

constexpr int kMaxRelayCycles = 1000;
constexpr std::size_t kMaxRelayRows = 100'000;

/// Simulates the test. Errors: invalid_argument with `where` = "plant/..." or "relay/<field>", also where the relay
/// cannot oscillate; unsupported where the plant cannot; cancelled.
Expected<RelayExperiment> simulate_relay(const Plant& plant, const RelaySettings& settings, const RunControl& control);

/// The checks of the settings alone, without the plant: the first fault.
std::optional<Error> refuse_settings(const RelaySettings& settings);

}  // namespace tunewright
