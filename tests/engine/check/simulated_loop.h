// Records of a simulated loop in operation whose cause is known: a plant with dead time, a PI controller, a load,
// noise, and one thing that is wrong.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "engine/check/loop_check.h"
#include "engine/plant/plant.h"
#include "tests/engine/tuning/random_plants.h"

namespace tunewright::check {

/// Choudhury, Thornhill and Shah 2005, Control Engineering Practice 13, 641: two parameters, the band S and the jump J.
/// It shares nothing with the models that the check fits.
class StickingValve {
public:
    StickingValve(double band, double jump, double at)
        : S_(band), J_(jump), position_(at), before_(at), stuck_at_(at) {}

    double operator()(double u) {
        const double move = u - before_;
        const int way = (move > 0) - (move < 0);
        if (threshold_ == 0 && way != direction_) {
            threshold_ = way == 0 ? J_ : S_;
            stuck_at_ = before_;
        }
        if (threshold_ > 0 && std::abs(u - stuck_at_) > threshold_) {
            threshold_ = 0;
            direction_ = u > stuck_at_ ? 1 : -1;
        }
        if (threshold_ == 0) position_ = u - direction_ * 0.5 * (S_ - J_);
        before_ = u;
        return position_;
    }

private:
    double S_, J_, position_, before_, stuck_at_, threshold_ = 1e-12;
    int direction_ = 0;
};

struct LoopSetUp {
    Fopdt plant{.K = 1, .T = 20, .L = 4};
    double Kp = 0, Ti = 0;  ///< 0: by SIMC with tau_c = `slowness` times the dead time
    double slowness = 1.5;
    double band = 0, jump = 0;         ///< of a sticking valve, % of u
    double load = 0.2;                 ///< standard deviation of a drifting load, % of u
    double noise = 0.03;               ///< of the measurement
    double sine = 0, sine_period = 0;  ///< a disturbance from outside, % of u
    double bias = 3;                   ///< a step of the load early in the record, % of u
    int set_point_moves = 0;
    double set_point_size = 2;
    double y_grid = 0.001, u_grid = 0.01;
    int rows = 3000;
    double step = 1;
    double manual_from = 2;  ///< share of the record from which nobody controls
};

inline double normal(test::Random& random) {
    return std::sqrt(-2 * std::log(random.uniform(1e-12, 1))) * std::cos(2 * std::numbers::pi * random.uniform(0, 1));
}

/// Set point 50, output about 50 %.
inline Record simulated(const LoopSetUp& s, std::uint64_t seed, const std::vector<double>& further_load = {}) {
    test::Random random(seed);
    const double tau = s.slowness * s.plant.L;
    const double Kp = s.Kp != 0 ? s.Kp : s.plant.T / (s.plant.K * (tau + s.plant.L));
    const double Ti = s.Ti != 0 ? s.Ti : std::min(s.plant.T, 4 * (tau + s.plant.L));
    const double a = std::exp(-s.step / s.plant.T), drift = std::exp(-s.step / (2 * Ti));
    const auto late = std::size_t(std::lround(s.plant.L / s.step));
    StickingValve valve(s.band, s.jump, 50);
    std::vector<double> held(late + 1, 0.0);
    double x = 0, load = 0, integral = 50, u = 50, r = 50;
    Record record;
    for (int i = 0; i < s.rows; ++i) {
        const double t = i * s.step;
        load = drift * load + s.load * std::sqrt(1 - drift * drift) * normal(random);
        double disturbed = load + (i > 0.02 * s.rows ? s.bias : 0);
        if (s.sine > 0) disturbed += s.sine * std::sin(2 * std::numbers::pi * t / s.sine_period);
        if (!further_load.empty()) disturbed += further_load[std::size_t(i)];
        const int apart = s.set_point_moves > 0 ? s.rows / (s.set_point_moves + 1) : 0;
        if (apart > 0 && i % apart == apart - 1 - int(2654435761U * seed % std::uint64_t(apart / 2)))
            r = r > 50 ? 50 : 50 + s.set_point_size;
        const double v = s.band > 0 ? valve(u) : u;
        held[std::size_t(i) % held.size()] = v - 50 + disturbed;
        x = a * x + (1 - a) * s.plant.K * held[std::size_t(i + 1) % held.size()];
        const double y = 50 + x + s.noise * normal(random);
        const double measured = s.y_grid > 0 ? std::round(y / s.y_grid) * s.y_grid : y;
        const bool automatic = i < s.manual_from * s.rows;
        if (automatic) {
            integral += Kp * (r - y) * s.step / Ti;
            const double wanted = Kp * (r - y) + integral;
            u = std::clamp(wanted, 0.0, 100.0);
            integral += u - wanted;
        }
        record.t.push_back(t);
        record.y.push_back(measured);
        record.r.push_back(r);
        record.u.push_back(std::round(u / s.u_grid) * s.u_grid);
    }
    return record;
}

/// The gain at which the loop of this plant and Ti is at its stability limit, by the phase of the sampled loop.
inline double ultimate_gain(const Fopdt& plant, double Ti, double step) {
    double before = 0;
    for (double w = 1e-3 / plant.L; w < std::numbers::pi / step; w *= 1.001) {
        const double phase =
            -std::atan(w * plant.T) - w * (plant.L + 0.5 * step) - std::numbers::pi / 2 + std::atan(w * Ti);
        if (before > -std::numbers::pi && phase <= -std::numbers::pi)
            return std::hypot(1, w * plant.T) / plant.K / std::hypot(1, 1 / (w * Ti));
        before = phase;
    }
    return 10;
}

}  // namespace tunewright::check
