// The interface of every tuning method: a plant in, a controller out, with the texts and options that describe it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/loop/margins.h"
#include "engine/plant/frequency_response.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/plant_family.h"
#include "engine/progress.h"
#include "engine/tuning/device/device_model.h"
#include "engine/tuning/method/method_report.h"
#include "engine/tuning/method/option_set.h"
#include "engine/tuning/method/options.h"
#include "engine/warning.h"

namespace tunewright {

class NonlinearSystem;

struct TunedController {
    IdealPid controller;
    bool nonlinear_integral = false;     ///< the answer is the Npid whose linear part `controller` is
    std::optional<Plant> reduced_model;  ///< the simpler model, if the rule needed one
    std::vector<Warning> warnings;
    std::shared_ptr<MethodReport> report;  ///< the method's own report; may be null
    std::optional<double> Ms_limit;        ///< the requested limit
    bool partial = false;                  ///< stopped early, with the best feasible design so far

    /// The report, if it is of this type; else null.
    template <class Report>
    const Report* report_as() const {
        return dynamic_cast<const Report*>(report.get());
    }
};

/// A design for an implemented controller, with the settings to enter.
struct DeviceDesign {
    TunedController tuned;  ///< its controller is the ideal equivalent of the settings
    device::Fitted fitted;
};

/// The controller of the method's answer.
inline Controller controller_of(const TunedController& tuned) {
    const IdealPid& pid = tuned.controller;
    if (tuned.nonlinear_integral) return Npid{.Kp = pid.Kp, .Ti = pid.Ti, .Td = pid.Td, .filter = pid.filter};
    return pid;
}

/// The (nominal) plant both as given and in the form that computations use; `dead_time_std` is the standard error of an
/// identified L. `family`: all plants on which limits must hold; empty: the plant alone. Methods without limits use the
/// nominal plant.
struct TuningProblem {
    Plant plant;
    LinearPlant linear;
    std::optional<double> dead_time_std;
    std::optional<PlantFamily> family = {};
    std::optional<UltimatePoint> relay_point = {};  ///< from the describing function of a recorded relay test
    /// The nonlinear plant of which `linear` is the linearisation, valid as long as the problem; else null.
    const NonlinearSystem* nonlinear = nullptr;
};

/// Options that make one row of a comparison of all methods.
struct MethodVariant {
    std::string name;  ///< e.g. "PI, servo, 20 %"
    MethodOptions options;
};

struct TuningMethod {
    std::string id;
    std::string title;
    std::string formula;   ///< as in the source, in plain text
    std::string source;    ///< author, year, publication
    std::string needs;     ///< "any linear plant", "fopdt (others are reduced)", ...
    std::string validity;  ///< the range the source claims
    std::vector<OptionDescription> options;
    /// Its variants in "all", each with a name for its title; empty: one for each choice of `controller` with integral
    /// action, or the defaults.
    std::vector<MethodVariant> variants = {};
    bool holds_family = false;    ///< limits hold on all of TuningProblem::family
    bool weighs_setpoint = true;  ///< its controllers have a set-point weight, which a request may choose
    /// Limit on the overshoot, in percent, that the method applies by itself if the options have none; empty: the
    /// source's weight stays.
    std::function<std::optional<double>(const MethodOptions&)> overshoot = {};
    bool compared = true;           ///< "all" runs it; false: only a request by name does
    bool all_if_nonlinear = false;  ///< "all" runs it on nonlinear plants only; by name it runs on any
    std::function<Expected<TunedController>(const TuningProblem&, const MethodOptions&, const RunControl&)> tune;
    /// For a plant known by measured points of its frequency response; empty: the method needs a model.
    std::function<Expected<TunedController>(const MeasuredPlant&, const MethodOptions&, const RunControl&)>
        tune_on_points = {};
    /// For an implemented controller: the limits hold on its loop. Empty: the method designs the ideal law, which is
    /// then converted.
    std::function<Expected<DeviceDesign>(const TuningProblem&, const MethodOptions&, const device::DeviceModel&,
                                         const RunControl&)>
        tune_for_device = {};
    std::vector<OptionDescription> options_on_points = {};  ///< with other defaults; empty: the same options

    /// Sets the options and the function that takes them as a struct: `solve(problem, options)`, or with the RunControl
    /// as a third argument.
    template <class Options, class Solve>
    void bind(const OptionSet<Options>& set, Solve solve) {
        options = set.descriptions();
        tune = [set, solve](const TuningProblem& problem, const MethodOptions& given, const RunControl& control) {
            return solved(solve, problem, set.read(given), control);
        };
    }
    template <class Options, class Solve>
    void serve_on_points(const OptionSet<Options>& set, Solve solve) {
        options_on_points = set.descriptions();
        tune_on_points = [set, solve](const MeasuredPlant& plant, const MethodOptions& given,
                                      const RunControl& control) { return solve(plant, set.read(given), control); };
    }

    template <class Options, class Solve>
    void bind_for_device(const OptionSet<Options>& set, Solve solve) {
        tune_for_device = [set, solve](const TuningProblem& problem, const MethodOptions& given,
                                       const device::DeviceModel& device, const RunControl& control) {
            return solve(problem, set.read(given), device, control);
        };
    }

private:
    template <class Solve, class Options>
    static Expected<TunedController> solved(const Solve& solve, const TuningProblem& problem, const Options& options,
                                            const RunControl& control) {
        if constexpr (std::is_invocable_v<Solve, const TuningProblem&, const Options&>)
            return solve(problem, options);
        else
            return solve(problem, options, control);
    }
};

}  // namespace tunewright
