// The method emulation on a plant of equations, for tests.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/tuning/method/method.h"

namespace tunewright {

/// A nonlinear plant as methods see it; what it points to lives as long as it does.
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

}  // namespace tunewright
