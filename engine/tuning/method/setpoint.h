// The set point's share in a design: its weight b, or a filter, chosen for the response to a set-point step. Neither
// touches the loop: the response to loads, Ms and Mt stay what they were.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/tuning/method/method.h"
#include "engine/warning.h"

namespace tunewright {

/// What a request may ask for; at most one of the three.
struct SetpointOptions {
    std::optional<double> weight = {};     ///< b itself, 0 to 1
    std::optional<double> overshoot = {};  ///< largest allowed, percent of the step, 0 to 100
    bool best_IAE = false;                 ///< the b with the least IAE
    bool may_filter = true;                ///< the controller has a filter of the set point, or may get one

    bool given() const { return weight || overshoot || best_IAE; }
};

/// The name of the option beside a method's own.
inline constexpr const char* kSetpointOption = "setpoint";

/// Its description, for every method whose controllers have weights; `by_default` is what they have unless asked.
/// `moved`: weight and overshoot have sliders, of a method that chooses the weight by itself.
OptionDescription setpoint_option(const std::string& by_default, bool moved);

SetpointOptions setpoint_options(const MethodOptions& given);

/// What `given` asks for, else what the method does by itself; the choice made joins `given`. Nothing for methods whose
/// controllers have no weight.
SetpointOptions wanted_setpoint(const TuningMethod& method, MethodOptions& given);

/// Gives `pid` the weight b that the options ask for, on a unit step without limits of u:
/// - overshoot: the b in [0, 1] with the least IAE among those that keep it; where none does, b and the set-point
///   filter with the least IAE that keep it together. Without a filter, or where none was found that is long enough,
///   the b with the least overshoot; in the latter case a warning says so. The response is affine in b, so its largest
///   value and its IAE are convex in b, and the b that keep a limit form an interval. An IAE is the least to 0.3 %.
/// - best_IAE: the b with the least IAE.
/// Weights need integral action and a stable loop; else the controller is left and a warning says so.
/// Source: Astrom and Hagglund, Advanced PID Control (2006), section 5.3.
std::vector<Warning> choose_setpoint(const LinearPlant& plant, const SetpointOptions& options, IdealPid& pid);

/// The same of a method's answer; its remarks join the answer's.
void weigh_setpoint(const LinearPlant& plant, const SetpointOptions& options, TunedController& tuned);

/// The same of a design for a controller as it is built: `fitted` is settled again with the weight, where it has one
/// and nothing else of it moves. `tuned` is its twin. Products have no filter of the set point.
void weigh_setpoint(device::Fitted& fitted, const device::DeviceModel& device, const LinearPlant& plant,
                    const SetpointOptions& options, TunedController& tuned);

/// A weight or a lag that keeps the overshoot of a set-point step.
struct SetpointCure {
    double b = 0;
    double lag = 0;  ///< T of a first-order lag of the set point; 0: the weight alone
};

/// A lower weight, where `may_weigh`; else the shortest lag of the set point with the weight as it is. Empty: neither
/// is known to keep `max_percent`. Linear, without limits of u.
std::optional<SetpointCure> cure_overshoot(const LinearPlant& plant, double max_percent, const IdealPid& pid,
                                           bool may_weigh);

}  // namespace tunewright
