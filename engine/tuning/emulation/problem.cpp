#include "engine/tuning/emulation/problem.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"
#include "engine/plant/nonlinear/linear_equations.h"
#include "engine/tuning/emulation/target.h"
#include "engine/tuning/method/rule.h"

namespace tunewright::emulation {
namespace {

constexpr double kShareOfInput = 0.05;   // of the nominal input, or of its range: the default step
constexpr double kTargetTimes = 8;       // the default horizon, in the target's slowest time
constexpr double kMaxTargetTimes = 640;  // of a given horizon, likewise: ten samples a time
constexpr double kFilterShare = 0.1;     // the default Tf over the target's time
constexpr NumberRange kAlpha{0.2, 5};    // the default of Eq. 3
constexpr double kShareOfTest = 0.4;     // of that step: a simulated test has no noise to stand out of
constexpr int kMinIntervals = 800, kMaxIntervals = 6400;
constexpr double kIntervalShare = 0.04;  // of the fastest time constant

Error wrong(const std::string& where, const std::string& sentence) {
    return {ErrorKind::invalid_argument, where, sentence};
}

std::string state_names(const NonlinearSystem& system) {
    std::string names;
    for (const NamedValue& state : system.description().states) names += (names.empty() ? "" : ", ") + state.name;
    return names;
}

Expected<Scenario> scenario_at(const std::string& path, const std::shared_ptr<const NonlinearSystem>& nominal,
                               const MethodOptions& options) {
    Scenario scenario;
    scenario.system = nominal;
    scenario.setpoint_step = options.number(path + "/setpoint_step").value_or(0);
    std::vector<NamedValue> changed;
    for (const std::string& name : options.names(path + "/parameters")) {
        changed.push_back({name, *options.number(path + "/parameters/" + name)});
        scenario.parameters[name] = changed.back().value;
    }
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
    for (const std::string& name : options.names(path + "/initial")) {
        const auto at = std::ranges::find(states, name, &NamedValue::name);
        if (at == states.end())
            return wrong(path + "/initial/" + name,
                         name + " is no state of the plant; its states are " + state_names(*nominal) + ".");
        if (scenario.x0.empty()) scenario.x0.assign(steady.begin(), steady.end());
        const double value = *options.number(path + "/initial/" + name);
        scenario.x0[static_cast<std::size_t>(at - states.begin())] = value;
        scenario.initial[name] = value;
    }
    if (scenario.setpoint_step == 0 && scenario.x0.empty())
        return wrong(
            path + "/setpoint_step",
            "setpoint_step is 0 and no state starts elsewhere: nothing would happen. Give a step, or initial.");
    return scenario;
}

// What u may be moved by for a test or a step of modest size.
double modest_input(const NonlinearSystem& system, double gain) {
    const double range = system.u_max() - system.u_min();
    if (std::isfinite(range)) return kShareOfInput * range;
    if (system.u_nominal() != 0) return kShareOfInput * std::abs(system.u_nominal());
    return (system.y_steady() != 0 ? kShareOfInput * std::abs(system.y_steady()) : 1) / gain;
}

Expected<std::vector<Scenario>> chosen_scenarios(Problem& problem, double modest, double gain,
                                                 const MethodOptions& options) {
    std::vector<Scenario> scenarios;
    for (std::size_t i = 0; i < options.size("scenarios"); ++i) {
        auto scenario = scenario_at("scenarios/" + std::to_string(i), problem.system, options);
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

Expected<LevelOneOptions> chosen_level_one(const Problem& problem, double modest, const MethodOptions& options) {
    LevelOneOptions level;
    for (std::size_t i = 0; i < options.size("bounds_from/methods"); ++i) {
        const std::string path = "bounds_from/methods/" + std::to_string(i);
        level.methods.push_back(options.text(path).value_or(""));
        if (level.methods.back() == "emulation" || find_method(level.methods.back()) == nullptr)
            return wrong(path, "bounds_from names the method " + level.methods.back() +
                                   ", which is none of the first level. Give ids of GET /v1/methods, such as imc, simc "
                                   "or ziegler_nichols_ultimate.");
    }
    if (level.methods.empty()) level.methods = {"imc", "ziegler_nichols_ultimate"};
    level.alpha = options.range("bounds_from/alpha").value_or(kAlpha);
    if (!(level.alpha.low < 1 && level.alpha.high > 1))
        return wrong("bounds_from/alpha", "alpha is [" + text(level.alpha.low) + ", " + text(level.alpha.high) +
                                              "]; the first must be below 1, the second above 1.");
    level.lambda = options.number("bounds_from/lambda")
                       .value_or(problem.relative_degree == 2 ? std::sqrt(problem.target.beta[2])
                                                              : target_time(problem.target) / problem.relative_degree);
    level.test_step = options.number("bounds_from/test_step").value_or(kShareOfTest * modest);
    if (level.test_step == 0)
        return wrong("bounds_from/test_step", "test_step is 0; a test without a step shows nothing.");
    level.relay_amplitude = options.number("bounds_from/relay_amplitude").value_or(modest);
    level.relay_hysteresis = options.number("bounds_from/relay_hysteresis");
    return level;
}

void choose_bounds(Problem& problem, const MethodOptions& options) {
    for (const char* name : {"Kp", "Ti", "Td"})
        if (const auto range = options.range(std::string("bounds/") + name)) problem.bounds[name] = *range;
    if (!problem.with_derivative) {
        if (problem.bounds.erase("Td") + options.has("Tf") + options.range("Tf").has_value() > 0)
            problem.warnings.push_back({"not-used", "A PI controller has no derivative part: Td and Tf are not used."});
        return;
    }
    if (const auto range = options.range("Tf")) problem.bounds["Tf"] = *range;
    problem.Tf = problem.free_Tf() ? std::sqrt(problem.bounds["Tf"].low * problem.bounds["Tf"].high)
                                   : options.number("Tf").value_or(kFilterShare * target_time(problem.target));
}

std::optional<Error> choose_horizon(Problem& problem, const MethodOptions& options) {
    const double slowest = slowest_time(problem.target), L = problem.system->dead_time();
    problem.horizon = options.number("horizon").value_or(kTargetTimes * slowest + L);
    const double longest = kMaxTargetTimes * slowest + L;
    if (problem.horizon <= longest) return std::nullopt;
    return wrong("horizon", "horizon is " + text(problem.horizon) + ", so long that the response, over after some " +
                                text(kTargetTimes * slowest) + ", would fall between two samples; it may be " +
                                text(longest) + " at most.");
}

std::optional<Error> choose_weights(Problem& problem, double gain, const MethodOptions& options) {
    const auto wy = options.number("weights/wy"), wu = options.number("weights/wu");
    problem.wu = wu.value_or(1);
    problem.wy = problem.remark6 ? 0 : wy.value_or((problem.wu > 0 ? problem.wu : 1) / (gain * gain));
    if (problem.remark6 && !(problem.wu > 0))
        return wrong("weights/wu", "wu is 0, and remark6 compares u alone. Give wu above 0, or formulation full.");
    if (problem.wu == 0 && problem.wy == 0)
        return wrong("weights", "wy and wu are both 0: nothing would be compared. Give one of them above 0.");
    return std::nullopt;
}

// As many as resolve the derivative filter and the target: Simpson's rule then leaves some 1e-6 of J.
int chosen_intervals(const Problem& problem) {
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

Expected<Problem> state_problem(const TuningProblem& plant, const MethodOptions& options) {
    Problem problem;
    problem.linear = &plant.linear;
    problem.system = {std::shared_ptr<const void>(), plant.nonlinear};  // lives as long as `plant`
    if (!problem.system) {
        auto equations = as_equations(plant.linear);
        if (!equations) return equations.error();
        problem.system = std::make_shared<const NonlinearSystem>(std::move(*equations));
    }
    const auto r = relative_degree(*problem.system);
    if (!r) return r.error();
    problem.relative_degree = *r;
    problem.zero_dynamics = zero_dynamics(*problem.system);
    const auto target = chosen_target(plant.linear, *r, options);
    if (!target) return target.error();
    problem.target = *target;
    problem.with_derivative = chosen_controller(options) == "PID";
    problem.error_derivative = options.text("derivative_on").value_or("measurement") == "error";
    problem.remark6 = options.text("formulation").value_or("full") == "remark6";
    const double gain = gain_size(plant.linear, plant_time(plant.linear));
    const double modest = modest_input(*problem.system, gain);
    auto scenarios = chosen_scenarios(problem, modest, gain, options);
    if (!scenarios) return scenarios.error();
    problem.scenarios = std::move(*scenarios);
    if (const auto error = choose_horizon(problem, options)) return *error;
    if (const auto error = choose_weights(problem, gain, options)) return *error;
    choose_bounds(problem, options);
    problem.intervals = chosen_intervals(problem);
    auto level_one = chosen_level_one(problem, modest, options);
    if (!level_one) return level_one.error();
    problem.level_one = std::move(*level_one);
    return problem;
}

}  // namespace tunewright::emulation
