#include "engine/tuning/emulation/trajectories.h"

#include "engine/number_text.h"

namespace tunewright::emulation {
namespace {

double square_integral(const std::vector<double>& values, const std::vector<double>& weights) {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += weights[i] * values[i] * values[i];
    return sum;
}

Error cannot_run(std::size_t scenario, const std::string& reason) {
    return {ErrorKind::unsupported, "scenarios/" + std::to_string(scenario),
            "The nonlinear controller itself cannot make this step: " + reason +
                " Give a smaller step, a slower target or wider limits of the input."};
}

}  // namespace

std::vector<double> simpson_weights(const EmulationProblem& problem) {
    const double third = problem.horizon / problem.intervals / 3;
    const auto intervals = static_cast<std::size_t>(problem.intervals);
    std::vector<double> weights(intervals + 1, 2 * third);
    for (std::size_t i = 1; i < intervals; i += 2) weights[i] = 4 * third;
    weights.front() = weights.back() = third;
    return weights;
}

Expected<std::vector<Trajectory>> nonlinear_trajectories(const EmulationProblem& problem, const RunControl& control) {
    const std::vector<double> weights = simpson_weights(problem);
    std::vector<Trajectory> trajectories;
    for (std::size_t i = 0; i < problem.scenarios.size(); ++i) {
        const Scenario& scenario = problem.scenarios[i];
        const auto run = simulate_linearising(
            *scenario.system, problem.target, scenario.setpoint_step,
            {.horizon = problem.horizon, .samples = problem.intervals + 1, .initial = scenario.x0}, control);
        if (control.stop.stop_requested())
            return Error{ErrorKind::cancelled, "", "The job was cancelled before a design was found."};
        if (!run.ended.empty()) return cannot_run(i, run.ended);
        Trajectory trajectory{run.even.y, run.even.u, 0, 0, run.limited};
        trajectory.y_size = square_integral(trajectory.y_nl, weights);
        trajectory.u_size = square_integral(trajectory.u_nl, weights);
        trajectories.push_back(std::move(trajectory));
    }
    return trajectories;
}

}  // namespace tunewright::emulation
