#include "engine/simulation/nonlinear/plant_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/number_text.h"

namespace tunewright {
namespace {}  // namespace

PlantRun::PlantRun(const NonlinearSystem& system, double tolerance)
    : system_(system),
      L_(system.dead_time()),
      integrator_({system.order(),
                   [this](double, std::span<const double> x, std::span<double> dx) {
                       return system_.rates(x, system_.u_nominal() + w_, dx);
                   },
                   [this, B = std::vector<double>(std::size_t(system.order()))](
                       double, std::span<const double> x, std::span<double> J, std::span<double> ft) mutable {
                       std::fill(ft.begin(), ft.end(), 0.0);
                       return system_.jacobian(x, system_.u_nominal() + w_, J, B);
                   }},
                  tolerance),
      x_(system.x_steady().begin(), system.x_steady().end()) {
    integrator_.start(0, x_);
}

void PlantRun::give_at(double t, double u) {
    u_ = u;
    pending_.push_back({t + L_, u});
    if (L_ == 0) arrive();
}

void PlantRun::arrive() {
    const double slack = 8 * std::numeric_limits<double>::epsilon() * std::max(t(), L_);
    if (pending_.empty() || pending_.front().t > t() + slack) return;
    while (!pending_.empty() && pending_.front().t <= t() + slack) {
        w_ = pending_.front().u;
        pending_.pop_front();
    }
    arrived_ = true;
    x_.assign(integrator_.x().begin(), integrator_.x().end());
    if (!integrator_.start(t(), x_)) read_step(OdeStep::left_domain);
}

bool PlantRun::step(double t_stop) {
    if (!why_.empty()) return false;
    if (!pending_.empty()) t_stop = std::min(t_stop, pending_.front().t);
    if (!read_step(integrator_.step(t_stop))) return false;
    arrive();
    return why_.empty();
}

bool PlantRun::shorten(double t) { return read_step(integrator_.shorten(t)); }

bool PlantRun::read_step(OdeStep outcome) {
    if (outcome != OdeStep::made) {
        const std::string at = "At t = " + text(t()) + " with u = " + text(u_) + " from its nominal value ";
        if (outcome == OdeStep::stalled) {
            why_ = at + "the required steps are too short to continue.";
            return false;
        }
        why_ = at + "the states leave the model's domain. " +
               fault_ahead(system_, integrator_.x(), integrator_.dx(), system_.u_nominal() + w_, t());
        return false;
    }
    const double from = integrator_.t_before(), h = t() - from;
    std::array<double, 6> y{};
    for (std::size_t k = 0; k < 6; ++k) {
        integrator_.at(k == 5 ? t() : from + kSixPoints[k] * h, x_);
        y[k] = system_.output(x_) - system_.y_steady();
        if (!std::isfinite(y[k])) return read_step(OdeStep::left_domain);
    }
    y_ = StepPolynomial::through(from, h, y);
    return true;
}

double PlantRun::unrest() const {
    double unrest = 0;
    const auto dx = integrator_.dx();
    for (std::size_t i = 0; i < dx.size(); ++i) unrest = std::max(unrest, std::abs(dx[i]) / integrator_.size(int(i)));
    return unrest;
}

std::string fault_ahead(const NonlinearSystem& system, std::span<const double> x, std::span<const double> dx, double u,
                        double t) {
    constexpr double kFirstLength = std::numeric_limits<double>::epsilon(), kMaxLength = 1e3, kLengthGrowth = 4;
    constexpr double kMinTimeForRounding = 1e-9;  // least t for the rounding near t = 0
    std::vector<double> ahead(x.size());
    double length = 0;
    while (length < kMaxLength) {
        for (std::size_t i = 0; i < x.size(); ++i) ahead[i] = x[i] + length * dx[i];
        if (std::string sentence = system.domain_fault(ahead, u); !sentence.empty()) return sentence;
        length = std::max(kLengthGrowth * length, kFirstLength * std::max(t, kMinTimeForRounding));
    }
    return "Their rates of change do not exist there.";
}

}  // namespace tunewright
