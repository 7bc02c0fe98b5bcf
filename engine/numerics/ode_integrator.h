// Ordinary differential equations step by step, each step with its dense output: explicit (Dormand and Prince, order 5)
// and, if stability rather than accuracy limits the explicit steps, by Rosenbrock's method (order 4, Hairer and
// Wanner's Rodas4 coefficients). Boost.Odeint computes the steps; their lengths are chosen here.
//
//   OdeIntegrator run(system, 1e-8);
//   run.start(0, x0);
//   while (run.t() < 10 && run.step(10) == OdeStep::made) ...   // run.at(t, x) anywhere between run.t_before() and t()
//
// Discontinuities are the caller's task: where the right-hand side changes its form, end the step there (`t_stop`, or
// `shorten` to a crossing found on the dense output) and call `start` again.
#pragma once

#include <functional>
#include <memory>
#include <span>

namespace tunewright {

struct OdeSystem {
    int order = 0;  ///< number of states, > 0
    /// dx = f(t, x). False if it does not exist there: the step is tried again, shorter.
    std::function<bool(double t, std::span<const double> x, std::span<double> dx)> rates;
    /// J = df/dx (order x order, row by row) and ft = df/dt, exact or approximate; by differences if it is empty.
    std::function<bool(double t, std::span<const double> x, std::span<double> J, std::span<double> ft)> jacobian = {};
};

enum class OdeStep {
    made,
    left_domain,  ///< f does not exist, however short the step
    stalled       ///< the tolerance is not met, however short the step
};

class OdeIntegrator {
public:
    /// `tolerance` (> 0) of each step's error in state i, relative to the larger of the state's least size and its
    /// largest movement since the first start.
    OdeIntegrator(OdeSystem system, double tolerance);
    ~OdeIntegrator();
    OdeIntegrator(OdeIntegrator&&) noexcept;
    OdeIntegrator& operator=(OdeIntegrator&&) noexcept;

    /// The least size of state i for relative errors (initially 0); infinite: its error is ignored.
    void set_least_size(int i, double size);

    /// Starts, or starts again after a jump of f or x. False if f does not exist.
    bool start(double t, std::span<const double> x);

    /// One step, at most to `t_stop` and then exactly onto it. After any result other than `made`, t and x are as
    /// before.
    OdeStep step(double t_stop);

    /// Repeats the last step from its beginning, exactly to `t_end` in (t_before, t]: to a crossing, or because an
    /// input of f has changed. On failure the run returns to the step's beginning.
    OdeStep shorten(double t_end);

    double t() const;
    double t_before() const;  ///< beginning of the last step
    std::span<const double> x() const;
    std::span<const double> x_before() const;
    std::span<const double> dx() const;  ///< f(t, x)
    double size(int i) const;            ///< size of state i to which errors are relative now
    double next_length() const;          ///< length of the step that would be tried next
    bool stiff() const;                  ///< true: the last step was Rosenbrock's

    /// States within the last step; of order 4, with errors like those of the step.
    void at(double t, std::span<double> x) const;

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

}  // namespace tunewright
