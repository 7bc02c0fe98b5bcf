#include "engine/simulation/nonlinear/linearising_response.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/number_text.h"
#include "engine/numerics/ode_integrator.h"
#include "engine/numerics/sign_change.h"
#include "engine/simulation/run/stopping_rule.h"

namespace tunewright {
namespace {

constexpr int kMaxSteps = 200000;
constexpr double kLimitTolerance = 1e-10;   // of the input's scale: the law must exceed a limit by this to count as
                                            // beyond it
constexpr double kFirstProbeShare = 1e-15;  // of the horizon: distance of the first probe for a fault
constexpr int kMaxProbes = 50;              // each at twice the distance; the last is beyond half the horizon
constexpr double kMaxInputEffect = 1e12;    // relative to the input's effect at the start

// u = (v - sum of beta_k L_f^k h) / (beta_r L_g L_f^(r-1) h).
class LinearisingLaw {
public:
    LinearisingLaw(const NonlinearSystem& system, const TargetResponse& target, double setpoint_step)
        : system_(system), beta_(target.beta), v_(setpoint_step) {}

    // Absolute u; not finite if it is undefined.
    double operator()(std::span<const double> x) {
        const auto r = beta_.size() - 1;
        if (!lie_derivatives(system_, static_cast<int>(r), x, lie_)) return std::nan("");
        double rest = v_ - (lie_.of_f[0] - system_.y_steady());
        for (std::size_t k = 1; k <= r; ++k) rest -= beta_[k] * lie_.of_f[k];
        return rest / (beta_[r] * lie_.of_g);
    }

    double input_effect() const { return lie_.of_g; }  // at the last evaluation

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

// The loop without dead time, from one crossing of a limit to the next: clipping is continuous but has a kink there.
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

    // Runs from x at t = 0 to the horizon: u at the samples; y, which is later by the dead time, is added after those
    // of `before`.
    LinearisingResponse run(std::span<const double> x, std::vector<double> before) {
        response_.even.y = std::move(before);
        const double u = law_(x);
        limit_ = u > system_.u_max() ? Limit::high : u < system_.u_min() ? Limit::low : Limit::none;
        response_.limited = limit_ != Limit::none;
        measure_input(u);
        sign_of_effect_ = law_.input_effect() < 0 ? -1 : 1;
        first_effect_ = std::abs(law_.input_effect());
        if (!integrator_.start(0, x)) return ended(reason(OdeStep::left_domain));
        sample_step();
        for (int steps = 0; integrator_.t() < options_.horizon; ++steps) {
            if (stop_.stop_requested()) return ended("The simulation was stopped.");
            if (steps == kMaxSteps)
                return ended("At t = " + text(now()) +
                             " the run has reached the limit "
                             "of " +
                             std::to_string(kMaxSteps) + " steps.");
            OdeStep outcome = integrator_.step(options_.horizon);
            if (outcome != OdeStep::made) return ended(reason(outcome));
            if (const auto pole = loss_of_effect()) {
                if (integrator_.shorten(*pole) == OdeStep::made) sample_step();
                return ended("At t = " + text(now()) +
                             " the controller's law becomes undefined: the input has no effect on the output there.");
            }
            const auto crossing = end_of_side();
            if (crossing && (outcome = integrator_.shorten(*crossing)) != OdeStep::made) return ended(reason(outcome));
            sample_step();
            if (crossing && !change_side()) return ended(reason(OdeStep::left_domain));
            if (too_strong()) return ended(reason(OdeStep::left_domain));
            if (escaped())
                return ended("At t = " + text(now()) +
                             " the input is unbounded: the plant's zero dynamics are unstable.");
        }
        response_.t_end = options_.horizon;
        return std::move(response_);
    }

private:
    // The input on the present side of the limits, even if the law has left it: smooth over a step.
    double input(std::span<const double> x) {
        if (limit_ == Limit::high) return system_.u_max();
        if (limit_ == Limit::low) return system_.u_min();
        return law_(x);
    }

    void measure_input(double u) {
        scale_u_ = std::abs(system_.u_nominal());
        for (const double size : {u, system_.u_min(), system_.u_max()})
            if (std::isfinite(size)) scale_u_ = std::max(scale_u_, std::abs(size - system_.u_nominal()));
    }

    bool escaped() {
        return scale_u_ > 0 && std::abs(input(integrator_.x()) - system_.u_nominal()) > kMaxResponseRatio * scale_u_;
    }

    // True if L_g L_f^(r-1) h has grown so much that the required u is only rounding.
    bool too_strong() {
        law_(integrator_.x());
        return std::abs(law_.input_effect()) > kMaxInputEffect * first_effect_;
    }

    std::optional<double> end_of_side() {
        if (std::isinf(system_.u_min()) && std::isinf(system_.u_max())) return std::nullopt;
        return first_crossing([this](double t) { return beyond(t); }, integrator_.t_before(), integrator_.t());
    }

    // The time within the step at which L_g L_f^(r-1) h changes its sign: u has a pole there, which y alone would not
    // show.
    std::optional<double> loss_of_effect() {
        const auto reversed = [this](std::span<const double> x) {
            law_(x);
            return -sign_of_effect_ * law_.input_effect();
        };
        if (!(reversed(integrator_.x()) > 0)) return std::nullopt;
        return first_crossing(
            [&](double t) {
                integrator_.at(t, inside_);
                return reversed(inside_);
            },
            integrator_.t_before(), integrator_.t());
    }

    // > 0 if the law has left the present side.
    double beyond(double t) {
        integrator_.at(t, inside_);
        const double u = law_(inside_);
        const double beyond = limit_ == Limit::high  ? system_.u_max() - u
                              : limit_ == Limit::low ? u - system_.u_min()
                                                     : std::max(u - system_.u_max(), system_.u_min() - u);
        return beyond - kLimitTolerance * scale_u_;
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
            u.push_back(std::clamp(law_(inside_), system_.u_min(), system_.u_max()) - system_.u_nominal());
        }
    }

    double now() const { return integrator_.t(); }

    // The reason why the loop cannot continue from here; the failing operation lies just ahead.
    std::string reason(OdeStep outcome) {
        const auto x = integrator_.x(), dx = integrator_.dx();
        const std::string at = "At t = " + text(now());
        const double u = input(x);
        if (!std::isfinite(u) || law_.input_effect() == 0) {
            const std::string fault = system_.domain_fault(x, system_.u_nominal());
            return at + (fault.empty()
                             ? " the controller's law is undefined: the input has no effect on the output there."
                             : " the states leave the model's domain. " + fault);
        }
        if (outcome == OdeStep::stalled) return at + " the required steps are too short to continue: u is unbounded.";
        std::vector<double> ahead(x.size());
        double h = kFirstProbeShare * options_.horizon;
        for (int doubling = 0; doubling < kMaxProbes; ++doubling, h *= 2) {
            for (std::size_t i = 0; i < ahead.size(); ++i) ahead[i] = x[i] + h * dx[i];
            const std::string fault = system_.domain_fault(ahead, u);
            if (!fault.empty()) return (at + " the states leave the model's domain. ").append(fault);
        }
        return at + " the controller's law becomes undefined.";
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
    double scale_u_ = 0, sign_of_effect_ = 1, first_effect_ = 0;
    std::vector<double> inside_;
    LinearisingResponse response_;
};

// The motion with the nominal input from 0 to the dead time: y at the samples before it, and x at its end.
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
        inside = steps < kMaxSteps && !stop.stop_requested() && run.step(L) == OdeStep::made;
        while (inside && waits(motion.y.size()) && sample_time(motion.y.size(), options) <= run.t()) {
            run.at(sample_time(motion.y.size(), options), motion.x);
            motion.y.push_back(system.output(motion.x) - system.y_steady());
        }
    }
    motion.x.assign(run.x().begin(), run.x().end());
    motion.t_end = run.t();
    if (!inside)
        motion.ended = stop.stop_requested() ? "The simulation was stopped."
                                             : "At t = " + text(run.t()) +
                                                   " the states leave the model's domain under the nominal input.";
    return motion;
}

}  // namespace

TargetResponse first_order_target(double gamma) { return {{1, gamma}}; }

TargetResponse second_order_target(double tau_cl, double xi) { return {{1, 2 * xi * tau_cl, tau_cl * tau_cl}}; }

TargetResponse target_of_poles(const std::vector<std::complex<double>>& poles) {
    std::vector<std::complex<double>> product = {1};
    for (const auto& pole : poles) {
        product.emplace_back(0);
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
