// Single steps of Rosenbrock's method for stiff equations, by Boost.Odeint. It has its own source because its matrices
// (Boost.uBLAS 1.74) use features that C++20 has removed: this header and its source are C++17.
#pragma once

#include <functional>
#include <memory>

namespace tunewright {

/// Order 4 with an error estimate of order 3, L-stable (Hairer & Wanner, Solving ODEs II, 1996, Rodas4).
class RosenbrockStepper {
public:
    using Rates = std::function<void(double t, const double* x, double* dx)>;
    /// J row by row.
    using Derivatives = std::function<void(double t, const double* x, double* J, double* ft)>;

    explicit RosenbrockStepper(int n);
    ~RosenbrockStepper();
    RosenbrockStepper(RosenbrockStepper&&) noexcept;
    RosenbrockStepper& operator=(RosenbrockStepper&&) noexcept;

    /// From x at t to x_new at t + h; not finite if J makes the step's equations singular.
    void step(const Rates& rates, const Derivatives& derivatives, const double* x, double t, double h, double* x_new,
              double* error);

    /// Prepares `at` for the last step.
    void keep();
    /// States at t + s h of the step that `keep` was called for, s in [0, 1].
    void at(double s, double* x) const;

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

}  // namespace tunewright
