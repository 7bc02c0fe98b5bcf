// The emulation problem: plants and scenarios to run, weights of their errors, and bounds of the settings.

#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/nonlinear/lie_derivatives.h"
#include "engine/simulation/nonlinear/linearising_response.h"
#include "engine/tuning/emulation/options.h"

namespace tunewright::emulation {

/// One run: a set-point step on the plant at rest, or from other states, or of a plant with other parameters (which
/// starts at its own steady state; the nonlinear controller knows it).
struct Scenario {
    double setpoint_step = 0;
    std::map<std::string, double> initial, parameters;
    std::shared_ptr<const NonlinearSystem> system;
    std::vector<double> x0;  ///< absolute states at t = 0; empty: the steady state
};

/// The rules and tests of the first level.
struct LevelOneOptions {
    std::vector<std::string> methods = {};  ///< ids of the registry
    NumberRange alpha;                      ///< alpha of Eq. 3, for magnitudes
    double lambda = 0;                      ///< of imc
    double test_step = 0;                   ///< of u
    double relay_amplitude = 0;             ///< of u
    std::optional<double> relay_hysteresis = {};
};

struct EmulationProblem {
    std::shared_ptr<const NonlinearSystem> system;
    const LinearPlant* linear = nullptr;  ///< its linearisation
    int relative_degree = 1;
    ZeroDynamics zero_dynamics;
    TargetResponse target;
    std::vector<Scenario> scenarios;
    bool default_scenario = false;  ///< true: no scenario was given
    bool with_derivative = true;    ///< true: PID, false: PI
    bool error_derivative = false;  ///< c = 1: the set-point step is differentiated
    bool remark6 = false;
    double horizon = 0;
    int intervals = 0;  ///< intervals between the samples of every run from 0 to the horizon; even, for Simpson's rule
    double wy = 0, wu = 1;
    double Tf = 0;                              ///< for a PID; the middle of its range if it is free
    std::map<std::string, NumberRange> bounds;  ///< the given bounds of Kp, Ti, Td, and of Tf if it is free
    LevelOneOptions level_one;
    std::vector<Warning> warnings;

    bool free_Tf() const { return bounds.contains("Tf"); }
};

/// Reads the options; missing ones are set from the linearisation (docs/methods.md). Errors: invalid_argument with the
/// option as `where`; those of the relative degree with `where` = "plant/...".
Expected<EmulationProblem> state_problem(const TuningProblem& plant, const EmulationOptions& options);

/// Magnitude of the linearisation's static gain; for an integrating plant the gain at frequency 1/time.
double gain_size(const LinearPlant& plant, double time);

/// The unknowns of the second level: Kp, Ti, with PID Td, with a free filter Tf, in this order.
using SettingsPoint = std::vector<double>;

/// The unknowns' names, in the order of a point's coordinates.
std::vector<std::string> unknowns(const EmulationProblem& problem);

struct Bounds {
    SettingsPoint low, high;
};

/// The controller at a point: b = 1, with a filter of the derivative for PID.
IdealPid controller_at(const EmulationProblem& problem, const SettingsPoint& point);

/// The point of a controller; a PI in a PID problem has Td = 0.
SettingsPoint point_of(const EmulationProblem& problem, const IdealPid& pid);

SettingsPoint clipped(const SettingsPoint& point, const Bounds& bounds);

/// The size of each unknown for relative changes: its magnitude, or near 0 a share of its range.
SettingsPoint sizes_of(const SettingsPoint& point, const Bounds& bounds);

/// The target response of the nonlinear controller: the option `target`, or a default from the linearisation. Errors:
/// invalid_argument, `where` = "target/...", if it does not fit the relative degree, which the message states, or is
/// not stable.
Expected<TargetResponse> chosen_target(const LinearPlant& plant, int relative_degree, const TargetOptions& options);

/// beta_1: the lags' sum, the area under 1 - y of a unit step.
double target_time(const TargetResponse& target);

/// 1/|Re p| of the slowest pole of the target.
double slowest_time(const TargetResponse& target);

/// 1/|p| of the slowest pole p != 0 of a plant; without such a pole ten dead times, or 1.
double plant_time(const LinearPlant& plant);

}  // namespace tunewright::emulation
