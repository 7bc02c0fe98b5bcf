#include "engine/tuning/emulation/options.h"

#include "engine/number_text.h"

namespace tunewright::emulation {
namespace {

constexpr int kMaxElements = 20;  // of the lists
const NumberOption kPositiveTime{.unit = "time", .exclusive_minimum = 0};

OptionSet<TargetOptions> target() {
    using O = TargetOptions;
    OptionSet<O> set;
    set.field(&O::gamma, "gamma", "gamma y' + y = set point.", kPositiveTime);
    set.field(&O::tau_cl, "tau_cl", "tau_cl^2 y'' + 2 xi tau_cl y' + y = set point.", kPositiveTime);
    set.field(&O::xi, "xi", "Damping ratio. Default: 1.", {.exclusive_minimum = 0});
    set.list(&O::poles, "poles", "As many poles as the relative degree, complex ones in conjugate pairs.",
             described_option(OptionType::complex, "pole", "A number or [re, im], in the open left half-plane.",
                              {.unit = "1/time"}),
             kMaxElements);
    return set;
}

OptionSet<ScenarioOptions> scenario() {
    using O = ScenarioOptions;
    OptionSet<O> set;
    set.field(&O::setpoint_step, "setpoint_step",
              "Set-point step from this plant's steady "
              "state.",
              {.unit = "y", .required = true});
    set.field(&O::initial, "initial", "States at t = 0 by name, absolute; the others are at their steady values.");
    set.field(&O::parameters, "parameters",
              "Other values of the plant's parameters by name: an uncertain plant is an additional scenario, and its "
              "nonlinear controller knows these values.");
    return set;
}

OptionSet<WeightOptions> weights() {
    OptionSet<WeightOptions> set;
    set.field(&WeightOptions::wy, "wy", "Default: wu over the square of the linearisation's static gain.",
              {.unit = "u^2/y^2", .minimum = 0});
    set.field(&WeightOptions::wu, "wu", "Weight of the input's difference.", {.minimum = 0});
    return set;
}

OptionSet<BoundOptions> bounds() {
    using O = BoundOptions;
    OptionSet<O> set;
    set.field(&O::Kp, "Kp", "[low, high], low < high for negative gains too.", {.unit = "u/y"});
    set.field(&O::Ti, "Ti", "[low, high], above 0.", kPositiveTime);
    set.field(&O::Td, "Td", "[low, high], from 0.", {.unit = "time", .minimum = 0});
    return set;
}

OptionSet<BoundsFromOptions> bounds_from() {
    using O = BoundsFromOptions;
    OptionSet<O> set;
    const NumberRange alpha = O{}.alpha;
    set.list(&O::methods, "methods",
             "Ids of methods. imc works on the linearisation and on a model identified from a simulated step test, "
             "ziegler_nichols_ultimate on a simulated relay test or the linearisation's ultimate point, all others "
             "on the linearisation. Default: these two.",
             described_option(OptionType::text, "method", "Id of a method."), kMaxElements);
    set.field(&O::alpha, "alpha",
              "Factors of the smallest and the largest of these values, Kp by size (Eq. 3): at least 0 and below 1, "
              "and above 1. Default: [" +
                  text(alpha.low) + ", " + text(alpha.high) + "].",
              {.minimum = 0});
    set.field(&O::lambda, "lambda",
              "Closed-loop time constant of imc. Default: the target's time "
              "constant.",
              kPositiveTime);
    set.field(&O::test_step, "test_step",
              "Step of the input in the simulated step test, not 0. Default: 2 % of the input's range, or of its "
              "nominal value.",
              {.unit = "u"});
    set.field(&O::relay_amplitude, "relay_amplitude",
              "Amplitude of the input in the simulated relay test. Default: 5 "
              "% of the input's range, or of its nominal value.",
              {.unit = "u", .exclusive_minimum = 0});
    set.field(&O::relay_hysteresis, "relay_hysteresis",
              "Hysteresis of the simulated relay test. Default: 0 with a dead time, else a tenth of the final change "
              "of y by the relay.",
              {.unit = "y", .minimum = 0});
    return set;
}

}  // namespace

OptionSet<EmulationOptions> described_options() {
    using O = EmulationOptions;
    OptionSet<O> set;
    add_controller(set, {ControllerKind::PI, ControllerKind::PID});
    set.object(&O::target, "target",
               "The target response of the nonlinear controller: gamma for relative degree 1, tau_cl and xi for 2, "
               "poles for any. Default: lags that sum to half the slowest time of the linearisation.",
               target());
    set.choice(&O::formulation, "formulation",
               "full: the PID's own run on the plant (Eq. 2); remark6: its error is that of the nonlinear controller's "
               "run, and only u is compared.",
               Words<Formulation>{{"full", Formulation::full}, {"remark6", Formulation::remark6}});
    set.list(&O::scenarios, "scenarios",
             "Runs over which J is averaged. Default: one set-point step that needs 5 % of the nominal input, or of "
             "its range.",
             described_option(OptionType::object, "scenario", "A run from t = 0."), kMaxElements, scenario());
    set.field(&O::horizon, "horizon",
              "The end of the integral in J. Default: eight times the target's slowest time after the dead time.",
              kPositiveTime);
    set.object(&O::weights, "weights", "J = mean of int wy (y_nl - y)^2 + wu (u_nl - u)^2 dt.", weights());
    set.object(&O::bounds, "bounds",
               "Bounds within which the optimum is searched. Missing ones come from "
               "bounds_from.",
               bounds());
    set.object(&O::bounds_from, "bounds_from",
               "The first level: which classical settings are computed, and how the bounds follow from them.",
               bounds_from());
    set.field(&O::Tf, "Tf",
              "Filter time of a PID's derivative part, or [low, high] to choose it too (Remark 5). Default: a "
              "tenth of the target's time.",
              kPositiveTime);
    set.choice(&O::derivative_on, "derivative_on",
               "measurement: derivative of y only; error: derivative of set point minus y, with a kick at a step.",
               Words<DerivativeOn>{{"measurement", DerivativeOn::measurement}, {"error", DerivativeOn::error}});
    return set.main({"target", "formulation", "scenarios", "horizon", "bounds"});
}

}  // namespace tunewright::emulation
