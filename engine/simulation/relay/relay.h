// A relay test on a linear plant: its simulation, and the plan of a good one.
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

/// From rest, u = u_plus at t = 0; e = -y: to u_minus when y > hysteresis, to u_plus when y < -hysteresis. If this
/// feedback would be positive (RelayExperiment::reversed), the relay acts on -y instead.
struct RelaySettings {
    double u_plus = 1, u_minus = -1;  ///< u_minus < u_plus; deviations from the operating point
    double hysteresis = 0;            ///< >= 0; y
    double noise_std = 0;             ///< >= 0; of white noise on each sample of y that the relay reads; y
    double relay_sample_time = 0;     ///< 0: switches at the time of crossing; else the relay's sample time
    /// Spacing of the record's rows; a whole multiple of relay_sample_time if that is not 0. Empty: Pu/200, or
    /// relay_sample_time; wider if the record would have more than kMaxRelayRows.
    std::optional<double> record_interval;
    int cycles = 10;              ///< 1 to 1000 cycles of u_plus and u_minus from t = 0
    int seed = 0;                 ///< seed of the noise; >= 0
    std::optional<double> shift;  ///< sigma of the limit cycle's shifted point, > 0; none: 1/Pu
};

/// u[i] holds from t[i]. Rows every record_interval and at every switch; the last row is the switch that ends the last
/// cycle.
struct RelayRecord {
    std::vector<double> t, u, y;
};

/// The recommended relay test for this plant. With noise: a hysteresis of 3 noise_std, which on average one white
/// sample in 741 exceeds by chance; levels, raised in proportion if needed, with which y swings by 3 times the
/// hysteresis to either side; 10 steady cycles for averaging (the error falls with the square root of their number).
/// Without noise: the given levels and hysteresis, and 3 steady cycles. The spacing of rows is 1, 2 or 5 times a power
/// of ten with at least 200 rows in a period, or a whole number of samples for a sampled relay.
struct RelayPlan {
    double u_plus = 0, u_minus = 0;
    double hysteresis = 0;
    double amplitude = 0;        ///< half of the resulting swing of y; y
    double expected_period = 0;  ///< time
    int cycles = 0;              ///< including those to settle
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

/// Simulates the test. Errors: invalid_argument with `where` = "plant/..." or "relay/<field>", also if the relay cannot
/// oscillate; unsupported if the plant cannot; cancelled.
Expected<RelayExperiment> simulate_relay(const Plant& plant, const RelaySettings& settings, const RunControl& control);

/// The first error of the settings alone, without the plant.
std::optional<Error> refuse_settings(const RelaySettings& settings);

}  // namespace tunewright
