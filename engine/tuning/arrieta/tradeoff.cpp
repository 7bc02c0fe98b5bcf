#include "engine/tuning/arrieta/tradeoff.h"

#include <cmath>
#include <utility>

#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"
#include "engine/tuning/arrieta/arrieta_rule.h"

namespace tunewright {
namespace {

constexpr double kTolerance = 1e-5;
constexpr const char* kUnstable = "The closed loop is not stable.";
constexpr const char* kNoIntegral = "Without integral action the error does not vanish, and its integral is infinite.";
constexpr const char* kUnsettled = "The response does not settle within the steps computed.";

std::optional<double> step_iae(const Loop& loop, const StepInputs& inputs) {
    ResponseOptions options;
    options.tolerance = options.settled = kTolerance;
    const StepResponse response = simulate_linear(loop.plant(), loop.gains(), inputs, options);
    if (!response.settles || !response.error_integral_final) return std::nullopt;
    return integral_of_absolute_error(response.nodes, inputs.r, response.error_integral_final);
}

// A stable loop with integral action, or why there is none.
Expected<Loop> usable_loop(const LinearPlant& plant, const ParallelPid& controller) {
    auto loop = Loop::make(plant, controller);
    if (!loop) return loop.error();
    if (!count_unstable_poles(*loop).stable()) return Error{ErrorKind::unstable_plant, "", kUnstable};
    return *loop;
}

Expected<double> iae_with(const LinearPlant& plant, const Pid& pid, const StepInputs& inputs) {
    const auto loop = usable_loop(plant, to_parallel(pid));
    if (!loop) return loop.error();
    const auto IAE = step_iae(*loop, inputs);
    if (!IAE) return Error{ErrorKind::numerical_failure, "", kUnsettled};
    return *IAE;
}

std::string no_static_gain(const LinearPlant& plant) {
    if (plant.integrators() > 0)
        return "An integrating plant has no static gain to scale the load's effect by, and no first-order model.";
    return "The plant's static gain is 0: no controller holds a set point.";
}

// What a reference controller reaches on the plant, or why it has no figure.
Figure reached(const Expected<double>& IAE, const std::string& whose) {
    return IAE ? Figure(*IAE) : no_figure(whose + IAE.error().message);
}

}  // namespace

TradeoffFigures no_tradeoff(const std::string& reason) {
    TradeoffFigures figures;
    for (Figure* figure : {&figures.J_r, &figures.J_d, &figures.J_rd, &figures.J_r_opt, &figures.J_d_opt,
                           &figures.I_perf, &figures.Deg, &figures.Ms})
        figure->why = reason;
    return figures;
}

Expected<ReferenceControllers> reference_controllers(const Fopdt& model) {
    auto ideal = ideal_controllers(model);
    if (!ideal) return ideal.error();
    ReferenceControllers references{model, *ideal, arrieta_pid(arrieta_free(), model)};
    if (references.free->Td < 0) references.free.reset();
    return references;
}

TradeoffScale::TradeoffScale(LinearPlant plant, const Expected<ReferenceControllers>& references)
    : plant_(std::move(plant)) {
    K_ = plant_.integrators() == 0 ? Figure(plant_.low_frequency_gain()) : no_figure(no_static_gain(plant_));
    if (!K_ || !references) {
        J_r_opt_ = J_d_opt_ = J_rd_free_ = no_figure(K_ ? references.error().message : K_.why);
        return;
    }
    J_r_opt_ =
        reached(iae_with(plant_, references->ideal.servo, {.r = 1}), "With the model's servo-optimal controller: ");
    J_d_opt_ =
        reached(iae_with(plant_, references->ideal.load, {.d = 1 / *K_}), "With the model's load-optimal controller: ");
    if (!references->free) {
        J_rd_free_ = no_figure(
            "The rule of Table 1 without a limit on Ms gives Td < 0 at this L/T: nothing to compare J_rd with.");
        return;
    }
    J_rd_free_ = figures(to_parallel(*references->free)).J_rd;
    if (!J_rd_free_) J_rd_free_.why = "With Table 1's controller without a limit on Ms: " + J_rd_free_.why;
}

TradeoffFigures TradeoffScale::figures(const ParallelPid& controller) const {
    if (!K_) return no_tradeoff(K_.why);
    const auto loop = usable_loop(plant_, controller);
    if (!loop) return no_tradeoff(loop.error().message);
    const double Ms = find_sensitivity_peak(*loop, make_peak_grid(*loop)).value;
    if (controller.Ki == 0) return placed(Ms, std::nullopt, std::nullopt, kNoIntegral);
    return placed(Ms, step_iae(*loop, {.r = 1}), step_iae(*loop, {.d = 1 / *K_}), kUnsettled);
}

TradeoffFigures TradeoffScale::placed(std::optional<double> Ms, std::optional<double> J_r, std::optional<double> J_d,
                                      const std::string& no_J) const {
    if (!K_) return no_tradeoff(K_.why);
    TradeoffFigures f;
    f.Ms = Ms ? finite_or(*Ms, "|S| has no finite peak.") : no_figure("|S| has no finite peak.");
    f.J_r = Figure(J_r, no_J);
    f.J_d = Figure(J_d, no_J);
    f.J_r_opt = J_r_opt_;
    f.J_d_opt = J_d_opt_;
    if (J_r && J_d && J_r_opt_ && J_d_opt_)
        f.J_rd = std::hypot(*J_r - *J_r_opt_, *J_d - *J_d_opt_);
    else
        f.J_rd = no_figure(!(J_r && J_d) ? no_J : !J_r_opt_ ? J_r_opt_.why : J_d_opt_.why);
    if (f.J_rd && *f.J_rd > 0 && J_rd_free_) {
        f.I_perf = *J_rd_free_ / *f.J_rd;
        f.Deg = 1 - *f.I_perf;
        return f;
    }
    f.I_perf = f.Deg = no_figure(!f.J_rd ? f.J_rd.why : *f.J_rd > 0 ? J_rd_free_.why : "J_rd is 0.");
    return f;
}

std::optional<double> TradeoffScale::degradation(const ParallelPid& controller) const {
    if (!K_ || !J_r_opt_ || !J_d_opt_ || !J_rd_free_ || controller.Ki == 0) return std::nullopt;
    const auto loop = usable_loop(plant_, controller);
    if (!loop) return std::nullopt;
    const auto J_r = step_iae(*loop, {.r = 1}), J_d = step_iae(*loop, {.d = 1 / *K_});
    if (!J_r || !J_d) return std::nullopt;
    return 1 - *J_rd_free_ / std::hypot(*J_r - *J_r_opt_, *J_d - *J_d_opt_);
}

}  // namespace tunewright
