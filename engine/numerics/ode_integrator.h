// Ordinary differential equations step by step, each step with its dense output: explicit (Dormand and Prince, order 5)
// and, where stability and not accuracy would limit the explicit steps, by Rosenbrock's method (order 4, Hairer and
// Wanner's Rodas4 coefficients). Boost.Odeint takes the steps; their lengths are chosen here.
//
//   OdeIntegrator run(system, 1e-8);
//   run.start(0, x0);
//   while (run.t() < 10 && run.step(10) == OdeStep::made) ...   // run.at(t, x) anywhere between run.t_before() and t()
//
// What is not smooth is the caller's: where the right-hand side changes its form, end the step there (`t_stop`, or
// `shorten` to a crossing found on the dense output) and `start` anew.
#pragma once

#include <functional>
#include <memory>
#include <span>

namespace tunewright {

struct OdeSystem {
    int order = 0;  ///< states, > 0
    /// dx = f(t, x). False where that does not exist: the step is tried again, shorter.
    std::function<bool(double t, std::span<const double> x, std::span<double> dx)> rates;
    /// J = df/dx (order x order, row by row) and ft = df/dt, exact or nearly; by differences where it is empty.
    std::function<bool(double t, std::span<const double> x, std::span<double> J, std::span<double> ft)> jacobian = {};
};

enum class OdeStep {
    made,
    left_domain,  ///< f does not exist however short the step
    stalled       ///< the tolerance is not met however short the step
};

class OdeIntegrator {
public:
    /// `tolerance` (> 0) of each step's error in state i, relative to the larger of the state's least size and how far
    /// it has moved since the first start.
    OdeIntegrator(OdeSystem system, double tolerance);
    ~OdeIntegrator();
    OdeIntegrator(OdeIntegrator&&) noexcept;
    OdeIntegrator& operator=(OdeIntegrator&&) noexcept;

    /// The size of state i that errors refer to at least (0 from the beginning); infinite: its error is not looked at.
    void set_least_size(int i, double size);

    /// Begins, or begins anew where f or x has jumped. False where f does not exist.
    bool start(double t, std::span<const double> x);

    /// One step, to `t_stop` at the most and then exactly onto it. After anything but `made`, t and x are as before.
    OdeStep step(double t_stop);

    /// Takes the last step once more from its beginning, to `t_end` in (t_before, t] exactly: to a crossing, or again
    /// because what f depends on has changed. On failure the run stands at the step's beginning.
    OdeStep shorten(double t_end);

    double t() const;
    double t_before() const;  ///< where the last step began
    std::span<const double> x() const;
    std::span<const double> x_before() const;
    std::span<const double> dx() const;  ///< f(t, x)
    double size(int i) const;            ///< that errors of state i refer to now
    double next_length() const;          ///< of the step that would be tried next
    bool stiff() const;                  ///< the last step was Rosenbrock's

    /// States within the last step; of order 4, errors like the step's own.
    void at(double t, std::span<double> x) const;

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

}  // namespace tunewright
