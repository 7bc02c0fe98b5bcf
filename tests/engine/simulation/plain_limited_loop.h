// A simple simulation of the loop with actuator limits in tiny steps, which shares no code with the product's.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "engine/simulation/limited/limited_response.h"

namespace tunewright {

struct Figures {
    double IAE = 0, max_u = -std::numeric_limits<double>::infinity(), time_at_max = 0,
           overshoot = -std::numeric_limits<double>::infinity();
    std::vector<double> y;  // at 1, 2, ... tenths of the horizon
};

/// Set point, load at the plant's input and load at its output over time.
struct PlainInputs {
    std::function<double(double)> r, d = [](double) { return 0.0; }, q = [](double) { return 0.0; };
};

/// The contract's control law and back-calculation written out, classical Runge-Kutta steps of L/m, delayed signal
/// linear between steps. Filters: none (without derivative), derivative, measurement_second_order.
class PlainSimulation {
public:
    PlainSimulation(const LinearPlant& plant, const ParallelPid& c, StepInputs in, ActuatorLimits limits, double Tt)
        : PlainSimulation(plant, c, {[in](double) { return in.r; }, [in](double) { return in.d; }}, limits, Tt) {}
    PlainSimulation(const LinearPlant& plant, const ParallelPid& c, PlainInputs in, ActuatorLimits limits, double Tt)
        : p_(plant.realisation()), c_(c), in_(std::move(in)), limits_(limits), Tt_(Tt), L_(plant.dead_time()) {}

    Figures run(double horizon, double dt) {
        const int lag = static_cast<int>(std::lround(L_ / dt)), n = static_cast<int>(std::lround(horizon / dt));
        std::vector<double> state(static_cast<std::size_t>(p_.n) + 3, 0.0), w(static_cast<std::size_t>(n) + 1, 0.0);
        Figures figures;
        const auto delayed = [&](int k) { return k >= lag ? w[static_cast<std::size_t>(k - lag)] : 0.0; };
        double last_error = 0;
        for (int k = 0; k <= n; ++k) {
            t_ = k * dt;
            const double u = std::clamp(command(state, delayed(k)), limits_.min, limits_.max), r = in_.r(t_);
            w[static_cast<std::size_t>(k)] = u + in_.d(t_);
            const double y = output(state, lag > 0 ? delayed(k) : 0), error = r - y;
            figures.overshoot = std::max(figures.overshoot, y - r);
            figures.max_u = std::max(figures.max_u, u);
            if (u >= limits_.max) figures.time_at_max += dt;
            if (k > 0) figures.IAE += 0.5 * dt * (std::abs(error) + std::abs(last_error));
            last_error = error;
            if (k > 0 && k % (n / 10) == 0) figures.y.push_back(y);
            if (k == n) break;
            const double v0 = delayed(k), v1 = k + 1 == lag ? 0.0 : delayed(lag > 0 ? k + 1 : k);
            runge_kutta(state, dt, v0, lag > 0 ? v1 : v0, lag == 0);
        }
        return figures;
    }

private:
    using State = std::vector<double>;

    double output(const State& s, double v) const {
        double y = p_.D * v + in_.q(t_);
        for (int i = 0; i < p_.n; ++i) y += p_.C[static_cast<std::size_t>(i)] * s[static_cast<std::size_t>(i)];
        return y;
    }
    double command(const State& s, double v) const {
        const std::size_t f = static_cast<std::size_t>(p_.n);  // filter state(s), then the integral part
        const double y = output(s, v), Tf = c_.filter.Tf;
        const double I = s[f + 2];
        switch (c_.filter.type) {
            case FilterType::derivative:
                return c_.Kp * (c_.b * in_.r(t_) - y) + I + c_.Kd * ((c_.c * in_.r(t_) - y) - s[f]) / Tf;
            case FilterType::measurement_second_order: return c_.Kp * (c_.b * in_.r(t_) - s[f]) + I - c_.Kd * s[f + 1];
            default: return c_.Kp * (c_.b * in_.r(t_) - y) + I;
        }
    }
    State rates(const State& s, double v, bool no_delay) const {
        const std::size_t f = static_cast<std::size_t>(p_.n);
        State rate(s.size(), 0.0);
        const double uc = command(s, v), u = std::clamp(uc, limits_.min, limits_.max);
        if (no_delay) v = u + in_.d(t_);  // D = 0 there
        const double y = output(s, v), Tf = c_.filter.Tf;
        for (std::size_t i = 0; i < f; ++i) {
            rate[i] = p_.B[i] * v;
            for (std::size_t j = 0; j < f; ++j) rate[i] += p_.A[i * f + j] * s[j];
        }
        double yf = y;
        if (c_.filter.type == FilterType::derivative) rate[f] = ((c_.c * in_.r(t_) - y) - s[f]) / Tf;
        if (c_.filter.type == FilterType::measurement_second_order) {
            yf = s[f];
            rate[f] = s[f + 1];
            rate[f + 1] = (y - s[f] - Tf * s[f + 1]) * 2 / (Tf * Tf);
        }
        rate[f + 2] = c_.Ki * (in_.r(t_) - yf) + (u - uc) / Tt_;
        return rate;
    }
    void runge_kutta(State& s, double dt, double v0, double v1, bool no_delay) {
        const auto at = [&](const State& k, double h) {
            State moved = s;
            for (std::size_t i = 0; i < s.size(); ++i) moved[i] += h * k[i];
            return moved;
        };
        const double vm = 0.5 * (v0 + v1);
        const State k1 = rates(s, v0, no_delay);
        t_ += dt / 2;
        const State k2 = rates(at(k1, dt / 2), vm, no_delay), k3 = rates(at(k2, dt / 2), vm, no_delay);
        t_ += dt / 2;
        const State k4 = rates(at(k3, dt), v1, no_delay);
        for (std::size_t i = 0; i < s.size(); ++i) s[i] += dt / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }

    const Realisation& p_;
    ParallelPid c_;
    PlainInputs in_;
    ActuatorLimits limits_;
    double Tt_, L_, t_ = 0;
};

}  // namespace tunewright
