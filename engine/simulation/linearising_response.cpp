#include "engine/simulation/linearising_response.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/number_text.h"
#include "engine/simulation/ode_integrator.h"

namespace tunewright {
namespace {

constexpr int kMostSteps = 200000;

// u = (v - sum of beta_k L_f^k h) / (beta_r L_g L_f^(r-1) h).
class LinearisingLaw {
public:
    LinearisingLaw(const NonlinearSystem& system, const TargetResponse& target, double setpoint_step)
        : system_(system), beta_(target.beta), v_(setpoint_step) {}

    // Absolute; not finite where it is undefined.
    double operator()(std::span<const double> x) {
        const auto r = beta_.size() - 1;
        if (!lie_derivatives(system_, static_cast<int>(r), x, lie_)) return std::nan("");
        double rest = v_ - (lie_.of_f[0] - system_.y_steady());
        for (std::size_t k = 1; k <= r; ++k) rest -= beta_[k] * lie_.of_f[k];
        return rest / (beta_[r] * lie_.of_g);
    }

    double input_effect() const { return lie_.of_g; }  // where it was last asked for

private:
    const NonlinearSystem& system_;
    const std::vector<double>& beta_;
    double v_;
    LieDerivatives lie_;
};

double sample_time(std::size_t i, const LinearisingOptions& options) {
    return options.horizon * static_cast<double>(i) / (options.samples - 1);
}

enum class Limit { none, low, high };

// The loop without dead time, from one crossing of a limit to the next: clipping is continuous but has a kink.
class LinearisedLoop {
public:
    LinearisedLoop(const NonlinearSystem& system, const TargetResponse& target, double setpoint_step,
                   const LinearisingOptions& options, std::stop_token stop)
        : system_(system),
          options_(options),
          stop_(std::move(stop)),
          law_(system, target, setpoint_step),
          integrator_({.order = system.order(),
                       .rates = [this](double, std::span<const double> x,
                                       std::span<double> dx) { return system_.rates(x, input(x), dx); }},
                      options.tolerance),
          inside_(static_cast<std::size_t>(system.order())) {}

    // From x at t = 0 to the horizon. u at the samples; y, which follows the dead time later, behind those of `before`.
    LinearisingResponse run(std::span<const double> x, std::vector<double> before) {
        response_.even.y = std::move(before);
        const double u = law_(x);
        limit_ = u > system_.u_max() ? Limit::high : u < system_.u_min() ? Limit::low : Limit::none;
        response_.limited = limit_ != Limit::none;
        if (!std::isfinite(u) || !integrator_.start(0, x)) return ended(reason(x));
        sample_step();
        for (int steps = 0; integrator_.t() < options_.horizon; ++steps) {
            if (stop_.stop_requested()) return ended("the run was stopped");
            if (steps == kMostSteps) return ended("the run takes more than " + std::to_string(kMostSteps) + " steps");
            if (integrator_.step(options_.horizon) != OdeStep::made) return ended(reason(integrator_.x()));
            const auto crossing =
                first_crossing([this](double t) { return beyond(t); }, integrator_.t_before(), integrator_.t());
            if (crossing && integrator_.shorten(*crossing) != OdeStep::made) return ended(reason(integrator_.x()));
            sample_step();
            if (crossing && !change_side()) return ended(reason(integrator_.x()));
        }
        response_.t_end = options_.horizon;
        return std::move(response_);
    }

private:
    double clipped(double u) const {
        return u > system_.u_max() ? system_.u_max() : u < system_.u_min() ? system_.u_min() : u;
    }

    // What the present side applies, whether or not the law has left it: smooth over a step.
    double input(std::span<const double> x) {
        if (limit_ == Limit::high) return system_.u_max();
        if (limit_ == Limit::low) return system_.u_min();
        return law_(x);
    }

    // > 0 where the law has left the present side.
    double beyond(double t) {
        integrator_.at(t, inside_);
        const double u = law_(inside_);
        if (limit_ == Limit::high) return system_.u_max() - u;
        if (limit_ == Limit::low) return u - system_.u_min();
        return std::max(u - system_.u_max(), system_.u_min() - u);
    }

    bool change_side() {
        const std::vector<double> x(integrator_.x().begin(), integrator_.x().end());
        const double u = law_(x);
        if (limit_ == Limit::none)
            limit_ = u - system_.u_max() > system_.u_min() - u ? Limit::high : Limit::low;
        else
            limit_ = Limit::none;
        response_.limited = true;
        return integrator_.start(integrator_.t(), x);
    }

    void sample_step() {
        auto& [y, u] = response_.even;
        const auto samples = static_cast<std::size_t>(options_.samples);
        for (double t; y.size() < samples && (t = sample_time(y.size(), options_) - system_.dead_time()) <= now();) {
            integrator_.at(t, inside_);
            y.push_back(system_.output(inside_) - system_.y_steady());
        }
        for (double t; u.size() < samples && (t = sample_time(u.size(), options_)) <= now();) {
            integrator_.at(t, inside_);
            u.push_back(clipped(law_(inside_)) - system_.u_nominal());
        }
    }

    double now() const { return integrator_.t(); }

    std::string reason(std::span<const double> x) {
        const double u = input(x);
        const std::string at = "at t = " + text(integrator_.t());
        if (!std::isfinite(u) || law_.input_effect() == 0)
            return "the linearising law is undefined " + at + ": the input has no effect on the output there";
        // Whatever fails lies just ahead.
        std::vector<double> dx(x.size()), ahead(x.begin(), x.end());
        for (double h = 1e-12 * options_.horizon; system_.rates(x, u, dx) && h < options_.horizon; h *= 2) {
            for (std::size_t i = 0; i < dx.size(); ++i) ahead[i] = x[i] + h * dx[i];
            const std::string fault = system_.domain_fault(ahead, u);
            if (!fault.empty()) return "the states left the model's domain " + at + ": " + fault;
        }
        return "the motion cannot be followed beyond t = " + text(integrator_.t()) +
               ": input or states grow without bound";
    }

    LinearisingResponse ended(const std::string& why) {
        const std::size_t both = std::min(response_.even.y.size(), response_.even.u.size());
        response_.even.y.resize(both);
        response_.even.u.resize(both);
        response_.t_end = integrator_.t();
        response_.ended = why;
        return std::move(response_);
    }

    const NonlinearSystem& system_;
    const LinearisingOptions& options_;
    std::stop_token stop_;
    LinearisingLaw law_;
    OdeIntegrator integrator_;
    Limit limit_ = Limit::none;
    std::vector<double> inside_;
    LinearisingResponse response_;
};

// Under the nominal input from 0 to the dead time: y at the samples before it, and x at its end.
struct FreeMotion {
    std::vector<double> y, x;
    std::string ended;
    double t_end = 0;
};

FreeMotion free_motion(const NonlinearSystem& system, const LinearisingOptions& options, const std::stop_token& stop) {
    const double L = system.dead_time();
    const auto waits = [&](std::size_t i) {
        return i < static_cast<std::size_t>(options.samples) && sample_time(i, options) < L;
    };
    FreeMotion motion;
    motion.x.assign(system.x_steady().begin(), system.x_steady().end());
    if (options.initial.empty()) {
        while (waits(motion.y.size())) motion.y.push_back(0);
        return motion;
    }
    OdeIntegrator run({.order = system.order(),
                       .rates = [&](double, std::span<const double> x,
                                    std::span<double> dx) { return system.rates(x, system.u_nominal(), dx); }},
                      options.tolerance);
    motion.x = options.initial;
    bool inside = run.start(0, motion.x);
    for (int steps = 0; inside && run.t() < L; ++steps) {
        inside = steps < kMostSteps && !stop.stop_requested() && run.step(L) == OdeStep::made;
        while (inside && waits(motion.y.size()) && sample_time(motion.y.size(), options) <= run.t()) {
            run.at(sample_time(motion.y.size(), options), motion.x);
            motion.y.push_back(system.output(motion.x) - system.y_steady());
        }
    }
    motion.x.assign(run.x().begin(), run.x().end());
    motion.t_end = run.t();
    if (!inside)
        motion.ended = "the motion under the nominal input cannot be followed beyond t = " + text(run.t()) + ": " +
                       (stop.stop_requested() ? "the run was stopped" : "the states leave the model's domain");
    return motion;
}

}  // namespace

TargetResponse first_order_target(double gamma) { return {{1, gamma}}; }

TargetResponse second_order_target(double tau_cl, double xi) { return {{1, 2 * xi * tau_cl, tau_cl * tau_cl}}; }

TargetResponse target_of_poles(const std::vector<std::complex<double>>& poles) {
    std::vector<std::complex<double>> product = {1};
    for (const auto& pole : poles) {
        product.push_back(0);
        for (auto k = product.size() - 1; k > 0; --k) product[k] -= product[k - 1] / pole;
    }
    TargetResponse target;
    for (const auto& coefficient : product) target.beta.push_back(coefficient.real());
    return target;
}

LinearisingResponse simulate_linearising(const NonlinearSystem& system, const TargetResponse& target,
                                         double setpoint_step, const LinearisingOptions& options,
                                         const RunControl& control) {
    FreeMotion before = free_motion(system, options, control.stop);
    if (!before.ended.empty())
        return {.even = {}, .limited = false, .t_end = before.t_end, .ended = std::move(before.ended)};
    return LinearisedLoop(system, target, setpoint_step, options, control.stop).run(before.x, std::move(before.y));
}

}  // namespace tunewright
