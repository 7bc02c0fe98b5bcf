#include "engine/tuning/emulation/emulation_problem.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"
#include "engine/numerics/polynomial_roots.h"
#include "engine/plant/nonlinear/linearisation.h"
#include "engine/tuning/emulation/emulation.h"
#include "engine/tuning/model_based/imc.h"
#include "engine/tuning/registry.h"
#include "engine/tuning/ultimate/ziegler_nichols_ultimate.h"

namespace tunewright::emulation {
namespace {

constexpr double kShareOfInput = 0.05;   // share of the nominal input, or of its range, for the default step
constexpr double kTargetTimes = 8;       // default horizon as a multiple of the target's slowest time
constexpr double kMaxTargetTimes = 640;  // largest given horizon as such a multiple: ten samples per time
constexpr double kFilterShare = 0.1;     // default Tf over the target's time
constexpr double kShareOfTest = 0.4;     // share of that step: a simulated test has no noise
constexpr int kMinIntervals = 800, kMaxIntervals = 6400;
constexpr double kIntervalShare = 0.04;  // share of the fastest time constant

Error wrong(const std::string& where, const std::string& sentence) {
    return {ErrorKind::invalid_argument, where, sentence};
}

std::string state_names(const NonlinearSystem& system) {
    std::string names;
    for (const NamedValue& state : system.description().states) names += (names.empty() ? "" : ", ") + state.name;
    return names;
}

Expected<Scenario> scenario_at(const std::string& path, const std::shared_ptr<const NonlinearSystem>& nominal,
                               const ScenarioOptions& options) {
    Scenario scenario;
    scenario.system = nominal;
    scenario.setpoint_step = options.setpoint_step;
    std::vector<NamedValue> changed;
    scenario.parameters = options.parameters;
    scenario.initial = options.initial;
    for (const auto& [name, value] : options.parameters) changed.push_back({name, value});
    if (!changed.empty()) {
        auto system = nominal->with(changed);
        if (!system) {
            const bool named = scenario.parameters.contains(system.error().where);
            return wrong(path + "/parameters" + (named ? "/" + system.error().where : ""), system.error().message);
        }
        scenario.system = std::make_shared<const NonlinearSystem>(std::move(*system));
    }
    const auto& states = nominal->description().states;
    const auto steady = scenario.system->x_steady();
    for (const auto& [name, value] : options.initial) {
        const auto at =
            std::ranges::find_if(states, [&id = name](const NamedValue& state) { return state.name == id; });
        if (at == states.end())
            return wrong(std::string(path).append("/initial/").append(name),
                         name + " is not a state of the plant; its states are " + state_names(*nominal) + ".");
        if (scenario.x0.empty()) scenario.x0.assign(steady.begin(), steady.end());
        scenario.x0[static_cast<std::size_t>(at - states.begin())] = value;
    }
    if (scenario.setpoint_step == 0 && scenario.x0.empty())
        return wrong(
            path + "/setpoint_step",
            "setpoint_step is 0 and all states start at their steady values, so nothing would happen. Give a step, or "
            "initial.");
    return scenario;
}

// The change of u for a test or a step of modest size.
double modest_input(const NonlinearSystem& system, double gain) {
    const double range = system.u_max() - system.u_min();
    if (std::isfinite(range)) return kShareOfInput * range;
    if (system.u_nominal() != 0) return kShareOfInput * std::abs(system.u_nominal());
    return (system.y_steady() != 0 ? kShareOfInput * std::abs(system.y_steady()) : 1) / gain;
}

Expected<std::vector<Scenario>> chosen_scenarios(EmulationProblem& problem, double modest, double gain,
                                                 const std::vector<ScenarioOptions>& given) {
    std::vector<Scenario> scenarios;
    for (std::size_t i = 0; i < given.size(); ++i) {
        auto scenario = scenario_at("scenarios/" + std::to_string(i), problem.system, given[i]);
        if (!scenario) return scenario.error();
        scenarios.push_back(std::move(*scenario));
    }
    if (!scenarios.empty()) return scenarios;
    Scenario step;
    step.system = problem.system;
    step.setpoint_step = modest * gain;
    problem.default_scenario = true;
    return std::vector<Scenario>{step};
}

Expected<LevelOneOptions> chosen_level_one(const EmulationProblem& problem, double modest,
                                           const BoundsFromOptions& options) {
    LevelOneOptions level;
    level.methods = options.methods;
    for (std::size_t i = 0; i < level.methods.size(); ++i) {
        const std::string& method = level.methods[i];
        if (method == kEmulation || find_method(method) == nullptr)
            return wrong("bounds_from/methods/" + std::to_string(i),
                         "bounds_from names the method " + method +
                             ", which the first level cannot use. Give ids of other methods, such as imc, simc or "
                             "ziegler_nichols_ultimate.");
    }
    if (level.methods.empty()) level.methods = {kImc, kZieglerNicholsUltimate};
    level.alpha = options.alpha;
    if (!(level.alpha.low < 1 && level.alpha.high > 1))
        return wrong("bounds_from/alpha", "alpha is [" + text(level.alpha.low) + ", " + text(level.alpha.high) +
                                              "]; the first must be below 1, the second above 1.");
    level.lambda =
        options.lambda.value_or(problem.relative_degree == 2 ? std::sqrt(problem.target.beta[2])
                                                             : target_time(problem.target) / problem.relative_degree);
    level.test_step = options.test_step.value_or(kShareOfTest * modest);
    if (level.test_step == 0) return wrong("bounds_from/test_step", "test_step is 0; it must not be 0.");
    level.relay_amplitude = options.relay_amplitude.value_or(modest);
    level.relay_hysteresis = options.relay_hysteresis;
    return level;
}

void choose_bounds(EmulationProblem& problem, const EmulationOptions& options) {
    const BoundOptions& given = options.bounds;
    for (const auto& [name, range] : {std::pair("Kp", given.Kp), {"Ti", given.Ti}, {"Td", given.Td}})
        if (range) problem.bounds[name] = *range;
    if (!problem.with_derivative) {
        if (problem.bounds.erase("Td") + options.Tf.has_value() > 0)
            problem.warnings.push_back({"not-used", "A PI controller has no derivative part: Td and Tf are not used."});
        return;
    }
    const auto* range = options.Tf ? std::get_if<NumberRange>(&*options.Tf) : nullptr;
    const auto* fixed = options.Tf ? std::get_if<double>(&*options.Tf) : nullptr;
    if (range != nullptr) problem.bounds["Tf"] = *range;
    problem.Tf = problem.free_Tf()  ? std::sqrt(problem.bounds["Tf"].low * problem.bounds["Tf"].high)
                 : fixed != nullptr ? *fixed
                                    : kFilterShare * target_time(problem.target);
}

std::optional<Error> choose_horizon(EmulationProblem& problem, const EmulationOptions& options) {
    const double slowest = slowest_time(problem.target), L = problem.system->dead_time();
    problem.horizon = options.horizon.value_or(kTargetTimes * slowest + L);
    const double longest = kMaxTargetTimes * slowest + L;
    if (problem.horizon <= longest) return std::nullopt;
    return wrong("horizon", "horizon is " + text(problem.horizon) +
                                ", which is too long: the response, which ends "
                                "after about " +
                                text(kTargetTimes * slowest) + ", would lie between two samples. It may be " +
                                text(longest) + " at most.");
}

std::optional<Error> choose_weights(EmulationProblem& problem, double gain, const WeightOptions& options) {
    problem.wu = options.wu;
    problem.wy = problem.remark6 ? 0 : options.wy.value_or((problem.wu > 0 ? problem.wu : 1) / (gain * gain));
    if (problem.remark6 && !(problem.wu > 0))
        return wrong("weights/wu", "wu is 0, but remark6 compares only u. Give wu above 0, or use formulation full.");
    if (problem.wu == 0 && problem.wy == 0)
        return wrong("weights", "wy and wu are both 0, so nothing would be compared. Give one of them above 0.");
    return std::nullopt;
}

// Enough intervals to resolve the derivative filter and the target: the error of Simpson's rule is then about 1e-6 of
// J.
int chosen_intervals(const EmulationProblem& problem) {
    double fastest = problem.target.beta.back() / problem.target.beta[problem.target.beta.size() - 2];
    if (problem.with_derivative)
        fastest = std::min(fastest, problem.free_Tf() ? problem.bounds.at("Tf").low : problem.Tf);
    int intervals = kMinIntervals;
    while (intervals < kMaxIntervals && problem.horizon / intervals > kIntervalShare * fastest) intervals *= 2;
    return intervals;
}

}  // namespace

double gain_size(const LinearPlant& plant, double time) {
    const double gain = plant.integrators() == 0 ? std::abs(plant.low_frequency_gain())
                                                 : std::abs(plant.at(std::complex<double>(0, 1 / time)));
    return std::isfinite(gain) && gain > 0 ? gain : 1;
}

Expected<EmulationProblem> state_problem(const TuningProblem& plant, const EmulationOptions& options) {
    EmulationProblem problem;
    problem.linear = &plant.linear;
    problem.system = {std::shared_ptr<const void>(), plant.nonlinear};  // valid as long as `plant`
    if (!problem.system) {
        auto equations = as_equations(plant.linear);
        if (!equations) return equations.error();
        problem.system = std::make_shared<const NonlinearSystem>(std::move(*equations));
    }
    const auto r = relative_degree(*problem.system);
    if (!r) return r.error();
    problem.relative_degree = *r;
    problem.zero_dynamics = zero_dynamics(*problem.system);
    const auto target = chosen_target(plant.linear, *r, options.target);
    if (!target) return target.error();
    problem.target = *target;
    problem.with_derivative = options.controller == ControllerKind::PID;
    problem.error_derivative = options.derivative_on == DerivativeOn::error;
    problem.remark6 = options.formulation == Formulation::remark6;
    const double gain = gain_size(plant.linear, plant_time(plant.linear));
    const double modest = modest_input(*problem.system, gain);
    auto scenarios = chosen_scenarios(problem, modest, gain, options.scenarios);
    if (!scenarios) return scenarios.error();
    problem.scenarios = std::move(*scenarios);
    if (const auto error = choose_horizon(problem, options)) return *error;
    if (const auto error = choose_weights(problem, gain, options.weights)) return *error;
    choose_bounds(problem, options);
    problem.intervals = chosen_intervals(problem);
    auto level_one = chosen_level_one(problem, modest, options.bounds_from);
    if (!level_one) return level_one.error();
    problem.level_one = std::move(*level_one);
    return problem;
}

std::vector<std::string> unknowns(const EmulationProblem& problem) {
    std::vector<std::string> names = {"Kp", "Ti"};
    if (problem.with_derivative) names.emplace_back("Td");
    if (problem.free_Tf()) names.emplace_back("Tf");
    return names;
}

IdealPid controller_at(const EmulationProblem& problem, const SettingsPoint& point) {
    IdealPid pid{.Kp = point[0], .Ti = point[1]};
    if (!problem.with_derivative) return pid;
    pid.Td = point[2];
    pid.c = problem.error_derivative ? 1 : 0;
    pid.filter = {FilterType::derivative, problem.free_Tf() ? point[3] : problem.Tf};
    return pid;
}

SettingsPoint point_of(const EmulationProblem& problem, const IdealPid& pid) {
    SettingsPoint point = {pid.Kp, pid.Ti};
    if (problem.with_derivative) point.push_back(pid.Td);
    if (problem.free_Tf()) point.push_back(pid.filter.Tf > 0 ? pid.filter.Tf : problem.Tf);
    return point;
}

SettingsPoint clipped(const SettingsPoint& point, const Bounds& bounds) {
    SettingsPoint inside = point;
    for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = std::clamp(inside[i], bounds.low[i], bounds.high[i]);
    return inside;
}

SettingsPoint sizes_of(const SettingsPoint& point, const Bounds& bounds) {
    constexpr double kMinShare = 1e-3;
    SettingsPoint sizes = point;
    for (std::size_t i = 0; i < sizes.size(); ++i)
        sizes[i] = std::max(std::abs(sizes[i]), kMinShare * (bounds.high[i] - bounds.low[i]));
    return sizes;
}

namespace {

constexpr double kShareOfPlantTime = 0.5;  // sum of the default target's lags over the plant's slowest time
constexpr double kConjugate = 1e-9;        // of a conjugate pair, relative

std::string cure(int r) {
    if (r == 1) return "Give gamma.";
    if (r == 2) return "Give tau_cl and xi, or two poles.";
    return "Give " + std::to_string(r) + " poles.";
}

Error unsuitable(const std::string& where, const std::string& given, int asked, int r) {
    return wrong(where, given + " is for relative degree " + std::to_string(asked) +
                            "; the plant's relative degree is " + std::to_string(r) + ". " + cure(r));
}

bool paired(const std::vector<std::complex<double>>& poles) {
    return std::ranges::all_of(poles, [&](const auto& p) {
        const auto is_partner = [&](const auto& q) { return std::abs(q - std::conj(p)) <= kConjugate * std::abs(p); };
        return std::ranges::count_if(poles, is_partner) ==
               std::ranges::count_if(poles, [&](const auto& q) { return std::abs(q - p) <= kConjugate * std::abs(p); });
    });
}

Expected<TargetResponse> of_given_poles(int r, const std::vector<std::complex<double>>& poles) {
    for (std::size_t i = 0; i < poles.size(); ++i)
        if (!(poles[i].real() < 0))
            return wrong("target/poles/" + std::to_string(i), "A pole of the target has the real part " +
                                                                  text(poles[i].real()) +
                                                                  "; it must be below 0, for a target that settles.");
    if (static_cast<int>(poles.size()) != r)
        return unsuitable("target/poles", "A target of " + std::to_string(poles.size()) + " poles",
                          static_cast<int>(poles.size()), r);
    if (!paired(poles))
        return wrong("target/poles",
                     "Complex poles of the target must come in conjugate pairs: [re, im] and [re, "
                     "-im].");
    return target_of_poles(poles);
}

TargetResponse by_default(const LinearPlant& plant, int r) {
    const double time = std::max(kShareOfPlantTime * plant_time(plant), plant.dead_time());
    if (r == 1) return first_order_target(time);
    if (r == 2) return second_order_target(time / 2, 1);
    return target_of_poles(std::vector<std::complex<double>>(static_cast<std::size_t>(r), -r / time));
}

}  // namespace

Expected<TargetResponse> chosen_target(const LinearPlant& plant, int r, const TargetOptions& options) {
    const auto &gamma = options.gamma, &tau_cl = options.tau_cl, &xi = options.xi;
    const bool poles = !options.poles.empty();
    if (gamma.has_value() + (tau_cl || xi) + poles > 1)
        return wrong("target",
                     "target must have exactly one of gamma, tau_cl (with xi) and poles; more than one is "
                     "given.");
    if (gamma && r != 1) return unsuitable("target/gamma", "gamma", 1, r);
    if (gamma) return first_order_target(*gamma);
    if (xi && !tau_cl) return wrong("target/tau_cl", "xi is given without tau_cl; give both.");
    if (tau_cl && r != 2) return unsuitable("target/tau_cl", "tau_cl", 2, r);
    if (tau_cl) return second_order_target(*tau_cl, xi.value_or(1));
    if (poles) return of_given_poles(r, options.poles);
    return by_default(plant, r);
}

double target_time(const TargetResponse& target) { return target.beta[1]; }

double slowest_time(const TargetResponse& target) {
    const std::vector<double> descending(target.beta.rbegin(), target.beta.rend());
    double slowest = 0;
    for (const auto& pole : polynomial_roots(descending)) slowest = std::max(slowest, 1 / std::abs(pole.real()));
    return slowest;
}

double plant_time(const LinearPlant& plant) {
    double slowest = 0;
    for (const auto& pole : plant.poles()) slowest = std::max(slowest, 1 / std::abs(pole));
    if (slowest > 0) return slowest;
    return plant.dead_time() > 0 ? 10 * plant.dead_time() : 1;
}

}  // namespace tunewright::emulation
