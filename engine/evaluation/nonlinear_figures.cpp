#include "engine/evaluation/nonlinear_figures.h"

#include <algorithm>
#include <cmath>

#include "engine/controller/pid.h"
#include "engine/loop/integral_sector.h"
#include "engine/number_text.h"
#include "engine/simulation/linear/indices.h"

namespace tunewright {
namespace {

constexpr double kStall = 1.5;  // times delta_r: the integral sees less than a third of the error

std::string statement_of(const IntegralSector& sector, const NonlinearFigures& figures) {
    if (sector.absolutely_stable())
        return std::string("The ") + (sector.circle_criterion ? "circle" : "Popov") +
               " criterion holds for the integral's gain in (0, 1]: every error dies out, whatever the step sizes and "
               "delta_r.";
    if (!sector.stable_without_integral)
        return "Without integral action the loop is unstable, and large errors leave it nearly without: they may grow. "
               "Ms and the margins hold for small errors only.";
    if (figures.limit_cycle_predicted)
        return "Neither criterion holds, and the describing function predicts an oscillation that grows beyond an "
               "amplitude of about " +
               text(*figures.limit_cycle_amplitude) + ": keep errors well below it.";
    if (!sector.stable_for_every_gain)
        return "Neither criterion holds, and with a weak integral the loop is unstable. Ms and the margins hold for "
               "small errors only.";
    return "Neither the circle nor the Popov criterion holds, which proves nothing; the describing function predicts "
           "no "
           "oscillation. Ms and the margins hold for small errors.";
}

void warn_of_stall(Evaluation& evaluation, const char* step, double largest_error, double delta_r) {
    if (largest_error <= kStall * delta_r) return;
    const double share = std::exp(-0.5 * std::pow(largest_error / delta_r, 2));
    evaluation.warnings.push_back(
        {"integral-stalls", std::string("The ") + step + " step drives the error to " + text(largest_error) +
                                ", beyond 1.5 delta_r = " + text(kStall * delta_r) + ": the integral sees " +
                                text(100 * share) +
                                " % of it there and hardly moves until P and D action have brought it back. A larger "
                                "delta_r or the linear PID recovers faster."});
}

}  // namespace

NonlinearFigures nonlinear_figures(const Loop& linear_part, double delta_r) {
    const IntegralSector sector = judge_integral_sector(linear_part);
    NonlinearFigures figures;
    figures.delta_r = delta_r;
    figures.stable_without_integral = sector.stable_without_integral;
    figures.circle_criterion = sector.circle_criterion;
    figures.popov_criterion = sector.popov_criterion;
    figures.popov_q = Figure(sector.popov_q, "No q meets Popov's condition.");
    figures.limit_cycle_predicted = sector.critical_gain.has_value();
    if (sector.critical_gain) {
        figures.limit_cycle_amplitude = ErrorScaling{delta_r}.amplitude_of_gain(*sector.critical_gain);
        figures.limit_cycle_omega = sector.critical_omega;
    } else {
        figures.limit_cycle_amplitude = figures.limit_cycle_omega = no_figure("No oscillation is predicted.");
    }
    figures.statement = statement_of(sector, figures);
    return figures;
}

void warn_of_linear_part(Evaluation& evaluation) {
    evaluation.warnings.push_back(
        {"linear-part",
         "Ms, Mt, Mks, the margins, frequency curves and noise figures belong to the linear part of this "
         "nonlinear PID, which rules where the error is far below delta_r."});
}

void warn_of_nonlinearity(Evaluation& evaluation, const StepResponse& setpoint, const StepResponse& load,
                          const EvaluateOptions& options) {
    const double delta_r = evaluation.nonlinear->delta_r;
    warn_of_linear_part(evaluation);
    evaluation.warnings.push_back(
        {"depends-on-step-size",
         "The responses are not proportional to the steps: these hold for a set-point step of " +
             text(options.setpoint_step) + " and a load step of " + text(options.load_step) +
             " with delta_r = " + text(delta_r) + "."});
    const Extremes of_setpoint = extremes_of_y(setpoint.nodes), of_load = extremes_of_y(load.nodes);
    const double r = options.setpoint_step;
    warn_of_stall(evaluation, "set-point",
                  std::max({std::abs(r), std::abs(r - of_setpoint.max), std::abs(r - of_setpoint.min)}), delta_r);
    warn_of_stall(evaluation, "load", std::max(std::abs(of_load.max), std::abs(of_load.min)), delta_r);
    if (options.actuator)
        evaluation.warnings.push_back(
            {"limits-not-applied", "The nonlinear PID is simulated without the actuator's limits; u may exceed them."});
}

}  // namespace tunewright
