// The set-point weight b, or a set-point filter, chosen for the response to a set-point step. Neither changes the loop:
// the response to loads, Ms and Mt stay the same.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/tuning/method/method.h"
#include "engine/warning.h"

namespace tunewright {

/// The set-point options of a request; at most one of the three.
struct SetpointOptions {
    std::optional<double> weight = {};     ///< b itself, from 0 to 1
    std::optional<double> overshoot = {};  ///< largest allowed overshoot, percent of the step, 0 to 100
    bool best_IAE = false;                 ///< use the b with the least IAE
    bool may_filter = true;                ///< the controller has a set-point filter, or may get one

    bool given() const { return weight || overshoot || best_IAE; }
};

/// The name of this option, which is added to a method's own.
inline constexpr const char* kSetpointOption = "setpoint";

/// Its description, for every method whose controllers have weights; `by_default` describes the weight without this
/// option. `moved`: weight and overshoot have sliders, because the method chooses the weight by itself.
OptionDescription setpoint_option(const std::string& by_default, bool moved);

SetpointOptions setpoint_options(const MethodOptions& given);

/// The option in `given`, else the method's own choice, which is then added to `given`. Nothing for methods whose
/// controllers have no weight.
SetpointOptions wanted_setpoint(const TuningMethod& method, MethodOptions& given);

/// Gives `pid` the weight b of the options, for a unit step without limits of u:
/// - overshoot: the b in [0, 1] with the least IAE among those that keep it; if none does, b and the set-point
///   filter with the least IAE that keep it together. Without a filter, or if no filter that is long enough was found,
///   the b with the least overshoot; in the latter case a warning says so. The response is affine in b, so its largest
///   value and its IAE are convex in b, and the b that keep a limit form an interval. An IAE is the least to 0.3 %.
/// - best_IAE: the b with the least IAE. Weights need integral action and a stable loop; otherwise the controller is
///   not changed and a warning says so. Source: Åström and Hägglund, Advanced PID Control (2006), section 5.3.
std::vector<Warning> choose_setpoint(const LinearPlant& plant, const SetpointOptions& options, IdealPid& pid);

/// The same for a method's answer; its remarks are added to the answer's.
void weigh_setpoint(const LinearPlant& plant, const SetpointOptions& options, TunedController& tuned);

/// The same for the design of an implemented controller: `fitted` is converted again with the weight, if it has one and
/// nothing else changes. `tuned` is its equivalent. Products have no set-point filter.
void weigh_setpoint(device::Fitted& fitted, const device::DeviceModel& device, const LinearPlant& plant,
                    const SetpointOptions& options, TunedController& tuned);

/// A weight or a lag that keeps the overshoot of a set-point step.
struct SetpointCure {
    double b = 0;
    double lag = 0;  ///< T of a first-order lag of the set point; 0: the weight alone
};

/// A lower weight if `may_weigh`; else the shortest set-point lag with the present weight. Empty: neither is known to
/// keep `max_percent`. For the linear loop without limits of u.
std::optional<SetpointCure> cure_overshoot(const LinearPlant& plant, double max_percent, const IdealPid& pid,
                                           bool may_weigh);

}  // namespace tunewright
