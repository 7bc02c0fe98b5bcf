// A nonlinear plant from its operating point, with an input that is constant between switches (open-loop experiments),
// and the operation of its equations that fails if it leaves its domain.
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/numerics/ode_integrator.h"
#include "engine/numerics/step_polynomial.h"
#include "engine/plant/nonlinear/nonlinear_system.h"

namespace tunewright {

/// u and y are deviations. A switch of u at t reaches the plant at t + L exactly.
class PlantRun {
public:
    PlantRun(const NonlinearSystem& system, double tolerance);
    PlantRun(const PlantRun&) = delete;  // its equations refer to it
    PlantRun& operator=(const PlantRun&) = delete;

    /// Sets u from now on, or from t in the last step. The latter is possible only with a dead time, before the change
    /// has reached the plant.
    void give(double u) { give_at(t(), u); }
    void give_at(double t, double u);
    /// Takes one step, at most to `t_stop` and to the next arrival of a switch. Returns false on failure; see why().
    bool step(double t_stop);
    /// Returns to a time within the last step.
    bool shorten(double t);

    double t() const { return integrator_.t(); }
    double u() const { return u_; }
    double y() const { return y_.at(1); }
    const StepPolynomial& last() const { return y_; }  ///< y over the last step
    bool nothing_arrived() const { return !arrived_; }
    /// The largest rate of change of a state, relative to the states' movement so far: 1/time.
    double unrest() const;
    const std::string& why() const { return why_; }

private:
    void arrive();
    bool read_step(OdeStep outcome);

    struct Switch {
        double t = 0, u = 0;
    };

    const NonlinearSystem& system_;
    double L_, u_ = 0, w_ = 0;
    bool arrived_ = false;
    OdeIntegrator integrator_;
    std::deque<Switch> pending_;
    std::vector<double> x_;
    StepPolynomial y_;
    std::string why_;
};

/// The operation that fails first if x continues with the rates dx from time t, as a sentence for the user
/// (NonlinearSystem::domain_fault). x and u are absolute. Cost: some tens of evaluations along that line.
std::string fault_ahead(const NonlinearSystem& system, std::span<const double> x, std::span<const double> dx, double u,
                        double t);

}  // namespace tunewright
