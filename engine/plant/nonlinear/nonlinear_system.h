// A nonlinear plant ready for computation: its equations compiled, its operating point an exact steady state.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/expected.h"
#include "engine/plant/nonlinear/nonlinear_plant.h"
#include "engine/plant/nonlinear/plant_program.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// x' = f(x, u), y = h(x), without the dead time. x and u are absolute.
class NonlinearSystem {
public:
    /// Compiles the equations and finds the steady state of the nominal input that is nearest to the given states
    /// (Newton's method with least-norm steps). Errors, invalid_argument with `where` = "plant/equations/T",
    /// "plant/parameters/k", "plant/output", "plant/input", "plant/states/T", "plant/L": a text that is not an
    /// expression (with its place), unknown or repeated names, a state without equation, a circular definition of
    /// parameters, a result that is not finite at the operating point (with the operation that fails), no steady state
    /// near.
    static Expected<NonlinearSystem> make(const NonlinearPlant& plant);

    /// The same plant with other values of some parameters, and its own steady state near this one. Errors: as above;
    /// for an unknown parameter `where` is its name.
    Expected<NonlinearSystem> with(const std::vector<NamedValue>& parameters) const;

    const NonlinearPlant& description() const { return plant_; }
    int order() const { return static_cast<int>(plant_.states.size()); }
    double dead_time() const { return plant_.L; }
    double u_nominal() const { return plant_.input.nominal; }
    double u_min() const;  ///< -infinity without a limit
    double u_max() const;
    std::span<const double> x_steady() const { return x_steady_; }
    double y_steady() const { return y_steady_; }

    /// dx = f(x, u). False if it is not finite: x has left the model's domain.
    bool rates(std::span<const double> x, double u, std::span<double> dx) const;
    /// h(x); not finite outside the domain.
    double output(std::span<const double> x) const;
    /// A = df/dx (n x n, row by row), B = df/du, exact. False outside the domain.
    bool jacobian(std::span<const double> x, double u, std::span<double> A, std::span<double> B) const;
    /// C = dh/dx, exact. False outside the domain.
    bool output_gradient(std::span<const double> x, std::span<double> C) const;
    /// The operation that fails at x and u, with its equation, as a sentence; empty inside the domain.
    std::string domain_fault(std::span<const double> x, double u) const;
    /// The same also if a value is finite but its derivative is not, such as sqrt at 0; without capital and full stop.
    std::string derivative_fault(std::span<const double> x, double u) const;

    /// The linearisation about the steady state, with the dead time; exact derivatives.
    const StateSpace& linearised() const { return linearised_; }

    /// Outputs 0 to n - 1 are f, output n is h; variables 0 to n - 1 are x, variable n is u.
    const Program& program() const { return program_->joint; }
    /// h alone, with the same variables.
    const Program& output_program() const { return program_->output; }

private:
    bool linearise();

    NonlinearPlant plant_;
    std::shared_ptr<const PlantProgram> program_;
    std::vector<double> x_steady_;
    double y_steady_ = 0;
    StateSpace linearised_;
};

}  // namespace tunewright
