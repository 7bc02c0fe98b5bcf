// The method emulation on plants given by equations, for tests: a conical tank, a pendulum, and the options of their
// steps.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/registry.h"

namespace tunewright {

/// A nonlinear plant in the form for methods; its references live as long as it does.
struct EmulationPlant {
    std::shared_ptr<const NonlinearSystem> system;
    TuningProblem problem;
};

inline EmulationPlant emulation_plant(const NonlinearPlant& plant) {
    auto system = std::make_shared<const NonlinearSystem>(NonlinearSystem::make(plant).value());
    const Plant linear = system->linearised();
    TuningProblem problem{linear, LinearPlant::make(linear).value(), std::nullopt, std::nullopt};
    problem.nonlinear = system.get();
    return {std::move(system), std::move(problem)};
}

inline Expected<TunedController> emulated(const TuningProblem& problem, const MethodOptions& options,
                                          const RunControl& control = {}) {
    return find_method("emulation")->tune(problem, options, control);
}

inline void set_range(MethodOptions& options, const std::string& path, double low, double high) {
    options.set(path + "/0", low);
    options.set(path + "/1", high);
}

/// h' = (q - c sqrt h)/(pi k^2 h^2): outflow by gravity from a cone; with time in units of time_unit.
inline NonlinearPlant conical_tank(double time_unit = 1, double y_unit = 1) {
    return {.states = {{"h", 1.0}},
            .parameters = {{"c", 0.5}, {"k", 0.4}, {"pi", 3.14159265358979323846}, {"a", time_unit}, {"b", y_unit}},
            .equations = {{"h", "(q - c*sqrt(h))/(pi*k^2*h^2)/a"}},
            .input = {.name = "q", .nominal = 0.5},
            .output = "b*h"};
}

/// Torque on a pendulum with quadratic damping, held at 0.3 rad.
inline NonlinearPlant pendulum() {
    return {.states = {{"angle", 0.3}, {"speed", 0.0}},
            .parameters = {{"a", 4.0}, {"b", 0.8}, {"d", 0.5}},
            .equations = {{"angle", "speed"}, {"speed", "-a*sin(angle) - b*speed*abs(speed) - d*speed + u"}},
            .input = {.name = "u", .nominal = 1.1820808266453582},
            .output = "angle"};
}

inline MethodOptions step_of(double r, double horizon, const char* controller) {
    MethodOptions options;
    options.set("controller", std::string(controller));
    options.set("scenarios/0/setpoint_step", r);
    options.set("horizon", horizon);
    return options;
}

inline MethodOptions cone_step(double time_unit = 1, double y_unit = 1) {
    MethodOptions options = step_of(0.3 * y_unit, 8 * time_unit, "PI");
    options.set("target/gamma", 1.5 * time_unit);
    options.set("weights/wy", 4 / (y_unit * y_unit));
    set_range(options, "bounds/Kp", 0.05 / y_unit, 5 / y_unit);
    set_range(options, "bounds/Ti", 0.2 * time_unit, 20 * time_unit);
    return options;
}

inline MethodOptions pendulum_step(double wy) {
    MethodOptions options = step_of(0.8, 4, "PID");
    options.set("target/tau_cl", 0.3);
    options.set("target/xi", 0.9);
    options.set("Tf", 0.05);
    options.set("weights/wy", wy);
    set_range(options, "bounds/Kp", 0.5, 50);
    set_range(options, "bounds/Ti", 0.1, 10);
    set_range(options, "bounds/Td", 0.05, 2);
    return options;
}

inline bool has_warning(const TunedController& answer, const std::string& code) {
    return std::ranges::find(answer.warnings, code, &Warning::code) != answer.warnings.end();
}

}  // namespace tunewright
