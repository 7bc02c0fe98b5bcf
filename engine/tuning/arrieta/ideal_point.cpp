#include "engine/tuning/arrieta/ideal_point.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "engine/loop/stability.h"
#include "engine/number_text.h"
#include "engine/numerics/extremum.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {
namespace {

constexpr double kTfOverTd = 0.1;
constexpr double kLargestTau = 50;
constexpr double kTolerance = 1e-4;   // of the simulation: its error of the IAE is 1e-5 and hardly changes nearby
constexpr double kFirstStep = 0.004;  // of a logarithm: about what interpolation leaves
constexpr double kAccuracy = 1e-6;    // of ln IAE
constexpr int kMaxSteps = 6000;
constexpr int kMaxEvaluations = 16;
constexpr double kNoController = 1e3;  // ln IAE of what does not settle

// An optimum at tau = L/T, scaled so that all is finite from tau = 0 on.
struct Optimum {
    double tau;
    double gain;             // Kp K L/(L + T)
    double integral_time;    // Ti/L of the load's, Ti/(L + T) of the set point's
    double derivative_time;  // Td/L
};

// Found by Nelder-Mead searches to 1e-10 of ln IAE, each restarted five times; tau = 0 is the limit.
constexpr Optimum kServo[] = {
    {0.00, 0.827138, 1.338904, 0.409726}, {0.05, 0.797318, 1.287200, 0.404075}, {0.10, 0.770355, 1.240376, 0.398483},
    {0.20, 0.723591, 1.158922, 0.387518}, {0.30, 0.684594, 1.090631, 0.377005}, {0.40, 0.651744, 1.032416, 0.367194},
    {0.50, 0.623663, 0.981234, 0.358508}, {0.62, 0.595451, 0.929375, 0.349105}, {0.75, 0.569228, 0.879034, 0.340898},
    {1.00, 0.529808, 0.803367, 0.326902}, {1.25, 0.500121, 0.746675, 0.315089}, {1.50, 0.477189, 0.704434, 0.304575},
    {1.75, 0.457831, 0.670484, 0.293979}, {2.00, 0.443252, 0.646426, 0.284682}, {2.50, 0.422178, 0.612052, 0.267966},
    {3.00, 0.407479, 0.585046, 0.260442}, {3.50, 0.401036, 0.566835, 0.257656}, {4.00, 0.394971, 0.551574, 0.251597},
    {5.00, 0.387455, 0.532310, 0.240523}, {6.00, 0.382279, 0.519151, 0.226237}, {7.00, 0.379537, 0.509846, 0.207493},
    {8.00, 0.377849, 0.504375, 0.189196}, {10.0, 0.375088, 0.496395, 0.160707}, {15.0, 0.371716, 0.486448, 0.118096},
    {25.0, 0.369617, 0.481193, 0.077950}, {50.0, 0.364740, 0.476589, 0.041884},
};
constexpr Optimum kLoad[] = {
    {0.00, 1.227279, 2.062479, 0.450869}, {0.05, 1.170434, 1.970976, 0.448499}, {0.10, 1.119241, 1.886654, 0.446374},
    {0.20, 1.031202, 1.737996, 0.442037}, {0.30, 0.958914, 1.612854, 0.436695}, {0.40, 0.898732, 1.505700, 0.431266},
    {0.50, 0.848039, 1.412496, 0.426178}, {0.62, 0.797223, 1.316410, 0.420143}, {0.75, 0.751814, 1.229160, 0.412834},
    {1.00, 0.683898, 1.100530, 0.393915}, {1.25, 0.632759, 0.994783, 0.379466}, {1.50, 0.592415, 0.903000, 0.372041},
    {1.75, 0.561773, 0.841729, 0.362003}, {2.00, 0.537587, 0.801336, 0.356057}, {2.50, 0.499522, 0.741621, 0.332152},
    {3.00, 0.476269, 0.699988, 0.308487}, {3.50, 0.465464, 0.669213, 0.290026}, {4.00, 0.458891, 0.647116, 0.272559},
    {5.00, 0.446819, 0.614866, 0.240102}, {6.00, 0.435432, 0.592212, 0.212108}, {7.00, 0.426437, 0.575705, 0.189640},
    {8.00, 0.419266, 0.562975, 0.171594}, {10.0, 0.408587, 0.544553, 0.144612}, {15.0, 0.393500, 0.519078, 0.106088},
    {25.0, 0.382263, 0.502510, 0.069864}, {50.0, 0.369954, 0.487014, 0.037762},
};

using LogSettings = std::vector<double>;  // ln Kp, ln Ti, ln Td on the model with K = 1, L + T = 1

double share(double tau) { return tau / (1 + tau); }

LogSettings start_at(std::span<const Optimum> table, double tau, bool load) {
    const auto right = std::ranges::find_if(table.begin() + 1, std::prev(table.end()),
                                            [tau](const Optimum& optimum) { return tau <= optimum.tau; });
    const Optimum &a = *std::prev(right), &b = *right;
    const double at = (share(tau) - share(a.tau)) / (share(b.tau) - share(a.tau));
    const double L = share(tau);
    return {std::log(std::lerp(a.gain, b.gain, at) / L),
            std::log(std::lerp(a.integral_time, b.integral_time, at) * (load ? L : 1)),
            std::log(std::lerp(a.derivative_time, b.derivative_time, at) * L)};
}

Pid controller_at(const LogSettings& x) {
    Pid pid;
    pid.Kp = std::exp(x[0]);
    pid.Ti = std::exp(x[1]);
    pid.Td = std::exp(x[2]);
    pid.filter = {FilterType::derivative, kTfOverTd * pid.Td};
    return pid;
}

double log_iae(const LinearPlant& plant, const LogSettings& x, bool load) {
    const ParallelPid gains = to_parallel(controller_at(x));
    const auto loop = Loop::make(plant, gains);
    if (!loop || !count_unstable_poles(*loop).stable()) return kNoController;
    ResponseOptions options;
    options.tolerance = options.settled = kTolerance;
    options.max_steps = kMaxSteps;
    const StepInputs inputs = load ? StepInputs{.d = 1} : StepInputs{.r = 1};
    const StepResponse response = simulate_linear(plant, gains, inputs, options);
    if (!response.settles || !response.error_integral_final) return kNoController;
    return std::log(integral_of_absolute_error(response.nodes, inputs.r, response.error_integral_final));
}

Pid best_from(const LogSettings& start, const LinearPlant& plant, bool load) {
    LocalOptions options;
    options.step = {kFirstStep, kFirstStep, kFirstStep};
    options.tolerance = kAccuracy;
    options.most_evaluations = kMaxEvaluations;
    const auto cost = [&](const LogSettings& x, bool&) { return log_iae(plant, x, load); };
    return controller_at(find_local_minimum(LocalSearch::nelder_mead, cost, start, options).x);
}

Pid scaled(Pid pid, double K, double time) {
    pid.Kp /= K;
    pid.Ti *= time;
    pid.Td *= time;
    pid.filter.Tf *= time;
    return pid;
}

Error refused(const std::string& message) { return {ErrorKind::unsupported, "plant", message}; }

}  // namespace

Expected<IdealControllers> ideal_controllers(const Fopdt& model) {
    if (!(model.T > 0 && model.K != 0))
        return refused(
            "The optimal controllers are those of a stable first-order model; this one has T = " + text(model.T) + ".");
    const double tau = model.L / model.T;
    if (!(tau > 0))
        return refused(
            "The model has no dead time: the error's integral falls without end as the gain grows, so there is no "
            "optimum to measure by.");
    if (tau > kLargestTau)
        return refused("The optimal controllers are known for L/T up to " + text(kLargestTau) + "; the model's is " +
                       text(tau) + ".");
    const double L = share(tau);
    const auto plant = LinearPlant::make(Fopdt{.K = 1, .T = 1 - L, .L = L});
    if (!plant) return plant.error();
    const double time = model.L + model.T;
    return IdealControllers{scaled(best_from(start_at(kServo, tau, false), *plant, false), model.K, time),
                            scaled(best_from(start_at(kLoad, tau, true), *plant, true), model.K, time)};
}

}  // namespace tunewright
