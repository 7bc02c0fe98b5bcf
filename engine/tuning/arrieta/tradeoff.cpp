#include "engine/tuning/arrieta/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "engine/number_text.h"
#include "engine/numerics/optimise/direct_search.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"
#include "engine/tuning/arrieta/arrieta_rule.h"

namespace tunewright {

namespace {

constexpr double kTolerance = 1e-5;
constexpr const char* kUnstable = "The closed loop is not stable.";
constexpr const char* kNoIntegral = "Without integral action the error does not go to 0, and its integral is infinite.";
constexpr const char* kUnsettled = "The response does not settle within the simulated steps.";

std::optional<double> step_iae(const Loop& loop, const StepInputs& inputs) {
    ResponseOptions options;
    options.tolerance = options.settled = kTolerance;
    const StepResponse response = simulate_linear(loop.plant(), loop.gains(), inputs, options);
    if (!response.settles || !response.error_integral_final) return std::nullopt;
    return integral_of_absolute_error(response.nodes, inputs.r, response.error_integral_final);
}

// A stable loop with integral action, or the error in its place.
Expected<Loop> usable_loop(const LinearPlant& plant, const ParallelPid& controller) {
    auto loop = Loop::make(plant, controller);
    if (!loop) return loop.error();
    if (!count_unstable_poles(*loop).stable()) return Error{ErrorKind::unstable_plant, "", kUnstable};
    return *loop;
}

Expected<double> iae_with(const LinearPlant& plant, const IdealPid& pid, const StepInputs& inputs) {
    const auto loop = usable_loop(plant, to_parallel(pid));
    if (!loop) return loop.error();
    const auto IAE = step_iae(*loop, inputs);
    if (!IAE) return Error{ErrorKind::numerical_failure, "", kUnsettled};
    return *IAE;
}

std::string no_static_gain(const LinearPlant& plant) {
    if (plant.integrators() > 0)
        return "An integrating plant has no static gain with which to scale the load's effect, and no first-order "
               "model.";
    return "The plant's static gain is 0: no controller holds a set point.";
}

// The IAE of a reference controller on the plant, or the reason for its absence.
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
        J_rd_free_ =
            no_figure("The rule of Table 1 without a limit on Ms gives Td < 0 at this L/T, so J_rd has no reference.");
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

namespace {

constexpr double kTfOverTd = 0.1;
constexpr double kLargestTau = 50;
constexpr double kRoughTolerance = 1e-4;   // of the simulation: the IAE has an error of 1e-5, which hardly changes
                                           // nearby
constexpr double kFirstStep = 0.004;       // of a logarithm: about the error of the interpolation
constexpr double kOptimumAccuracy = 1e-6;  // of ln IAE
constexpr int kMaxSteps = 6000;
constexpr int kMaxEvaluations = 16;
constexpr double kNoController = 1e3;  // ln IAE of a response that does not settle

// An optimum at tau = L/T, scaled so that all members are finite from tau = 0.
struct Optimum {
    double tau;
    double gain;             // Kp K L/(L + T)
    double integral_time;    // Ti/L for the load optimum, Ti/(L + T) for the set-point optimum
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

IdealPid controller_at(const LogSettings& x) {
    IdealPid pid;
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
    options.tolerance = options.settled = kRoughTolerance;
    options.max_steps = kMaxSteps;
    const StepInputs inputs = load ? StepInputs{.d = 1} : StepInputs{.r = 1};
    const StepResponse response = simulate_linear(plant, gains, inputs, options);
    if (!response.settles || !response.error_integral_final) return kNoController;
    return std::log(integral_of_absolute_error(response.nodes, inputs.r, response.error_integral_final));
}

IdealPid best_from(const LogSettings& start, const LinearPlant& plant, bool load) {
    LocalOptions options;
    options.step = {kFirstStep, kFirstStep, kFirstStep};
    options.tolerance = kOptimumAccuracy;
    options.max_evaluations = kMaxEvaluations;
    const auto cost = [&](const LogSettings& x, bool&) { return log_iae(plant, x, load); };
    return controller_at(find_local_minimum(LocalSearch::nelder_mead, cost, start, options).x);
}

IdealPid scaled(IdealPid pid, double K, double time) {
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
            "The model has no dead time: the error's integral goes to 0 as the gain grows, so there is no optimum as a "
            "reference.");
    if (tau > kLargestTau)
        return refused("The optimal controllers are known for L/T up to " + text(kLargestTau) +
                       ", but the model's "
                       "is " +
                       text(tau) + ".");
    const double L = share(tau);
    const auto plant = LinearPlant::make(Fopdt{.K = 1, .T = 1 - L, .L = L});
    if (!plant) return plant.error();
    const double time = model.L + model.T;
    return IdealControllers{scaled(best_from(start_at(kServo, tau, false), *plant, false), model.K, time),
                            scaled(best_from(start_at(kLoad, tau, true), *plant, true), model.K, time)};
}

}  // namespace tunewright
