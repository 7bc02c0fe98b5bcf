// The program of a test that a controller runs by itself: a relay test, or a step and back.
//
// It stands between the loop's own controller and the actuator. Idle, it passes the controller's u on. When `start`
// rises, it holds u, measures the noise of y, moves u, and ends by itself: u is then again what it was before. On a
// fault u is the safe value from that very call on, until `start` falls. Each call of a running test gives a row t, u,
// y that `identify` reads; u of a row is held until the next row.
//
// Source of the relay test: K. J. Åström and T. Hägglund, Automatica 20 (1984) 645-651; unequal levels, which also show
// the static gain: Liu and Gao (2009). Noise from differences of successive samples: J. von Neumann, Ann. Math. Stat.
// 12 (1941) 367-395; for Gaussian noise the mean difference is 2/sqrt(pi) standard deviations.
#pragma once

#include <optional>

#include "engine/code/program.h"
#include "engine/expected.h"

namespace tunewright::code {

enum class Experiment { relay, bump };

constexpr double kLargestAsymmetry = 0.8;
constexpr int kMostCycles = 1000;

/// The sign of the plant's gain, as its controller knows it.
enum class Action {
    find,     ///< from the first move of y; not for a plant that is unstable or first moves the wrong way
    reverse,  ///< the controller lowers u when y rises: a positive gain
    direct,   ///< a negative gain
};

/// Times in seconds; u and y in the units of the signals. An empty limit is none.
struct ExperimentOptions {
    double Ts = 0;                                 ///< > 0: time from call to call
    double u_step = 0;                             ///< relay: > 0; bump: not 0, with its sign
    double asymmetry = 0.3;                        ///< relay: u0 + u_step (1 + asymmetry), u0 - u_step (1 - asymmetry)
    std::optional<double> u_min = {}, u_max = {};  ///< the levels are limited to this range; u_min < u_max
    std::optional<double> y_min = {}, y_max = {};  ///< y beyond them is a fault; y_min < y_max
    std::optional<double> u_safe = {};             ///< u after a fault; empty: that before the test
    double rate_limit = 0;                         ///< > 0: largest change of u per second, faults excepted
    double quiet_time = 0;                         ///< u held while the noise is measured; 0: 30 calls
    double max_time = 0;                           ///< of the whole test; 0: 5000 calls
    double hysteresis = 0;                         ///< its least size; the noise may demand more
    double frozen_time = 0;                        ///< y unchanged for longer is a fault; 0: from the quiet time
    double y_move = 0;                             ///< bump: ends the step when y has moved so far; 0: no such end
    int cycles = 0;                                ///< relay: exactly so many; 0: until the cycle is steady
    Action action = Action::find;                  ///< relay
};

/// Values of the output `mode`.
enum class ExperimentMode { idle, quiet, first_move, test, done, stopped };

/// Values of the output `reason`; each has its sentence in the program.
enum class ExperimentReason {
    none = 0,
    settled = 1,
    cycles = 2,
    by_operator = 3,
    sensor = 10,
    frozen = 11,
    y_low = 12,
    y_high = 13,
    u_refused = 14,
    clock = 15,
    restarted = 16,
    no_response = 17,
    time = 18,
    settings = 19,
};

/// Errors (invalid_argument, `where` names the field): a size or time out of its range, limits in the wrong order.
Expected<Program> experiment_algorithm(Experiment kind, const ExperimentOptions& options);

}  // namespace tunewright::code
