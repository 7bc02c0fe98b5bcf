// Options of the method emulation.
#pragma once

#include <complex>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/tuning/method/rule.h"

namespace tunewright::emulation {

/// The target response of the nonlinear controller: gamma for relative degree 1, tau_cl and xi for 2, poles for any;
/// none: lags that sum to half the slowest time of the linearisation.
struct TargetOptions {
    std::optional<double> gamma = {};              ///< gamma y' + y = v, in time
    std::optional<double> tau_cl = {}, xi = {};    ///< tau_cl^2 y'' + 2 xi tau_cl y' + y = v
    std::vector<std::complex<double>> poles = {};  ///< in 1/time
};

/// A run from t = 0.
struct ScenarioOptions {
    double setpoint_step = 0;                    ///< step in y, from this plant's steady state
    std::map<std::string, double> initial = {};  ///< states at t = 0, absolute; the others are at their steady values
    std::map<std::string, double> parameters = {};  ///< other values of the plant's parameters
};

/// J = mean of int wy (y_nl - y)^2 + wu (u_nl - u)^2 dt.
struct WeightOptions {
    std::optional<double> wy = {};  ///< empty: wu over the square of the linearisation's static gain
    double wu = 1;
};

/// Bounds within which the optimum is searched; missing ones come from BoundsFromOptions.
struct BoundOptions {
    std::optional<NumberRange> Kp = {}, Ti = {}, Td = {};
};

/// The first level: which classical settings are computed, and how the bounds follow from them.
struct BoundsFromOptions {
    std::vector<std::string> methods = {};  ///< ids of the registry; empty: imc and Ziegler and Nichols' ultimate rule
    NumberRange alpha{0.2, 5};              ///< factors of the smallest and of the largest value (Eq. 3), Kp by size
    std::optional<double> lambda = {};      ///< lambda of imc; empty: the target's time constant
    std::optional<double> test_step = {};   ///< step of u, not 0
    std::optional<double> relay_amplitude = {};  ///< of u
    std::optional<double> relay_hysteresis = {};
};

enum class Formulation {
    full,     ///< the PID's own run on the plant (Eq. 2)
    remark6,  ///< its error is that of the nonlinear controller's run, and only u is compared
};

/// Input of the derivative part: y only, or set point minus y, with a kick at a step.
enum class DerivativeOn { measurement, error };

struct EmulationOptions {
    ControllerKind controller = ControllerKind::PID;
    TargetOptions target = {};
    Formulation formulation = Formulation::full;
    std::vector<ScenarioOptions> scenarios = {};
    std::optional<double> horizon = {};
    WeightOptions weights = {};
    BoundOptions bounds = {};
    BoundsFromOptions bounds_from = {};
    std::optional<std::variant<double, NumberRange>> Tf = {};  ///< a range: Tf is optimised too (Remark 5)
    DerivativeOn derivative_on = DerivativeOn::measurement;
};

OptionSet<EmulationOptions> described_options();

}  // namespace tunewright::emulation
