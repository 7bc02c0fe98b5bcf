#include "tests/records/true_plant.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unsupported/Eigen/MatrixFunctions>

namespace tunewright::records {
namespace {

using Complex = std::complex<double>;

/// Dead time up to five times the lags; in a fifth of the plants none.
double some_dead_time(double lags, Random& random) {
    return random.chance(0.2) ? 0 : lags * (random.chance(0.8) ? random.spread(0.03, 1) : random.spread(1, 5));
}

void spread_lags(TruePlant& plant, Random& random) {
    const double T = random.spread(1, 300);
    plant.lags = {T};
    if (random.chance(0.5)) {
        const double small = T * random.spread(0.1, 0.3);
        for (int k = 3 + random.below(4); k > 0; --k) plant.lags.push_back(small);
    } else {
        for (int k = 1 + random.below(4); k > 0; --k)
            plant.lags.push_back(plant.lags.back() * random.uniform(0.2, 0.8));
    }
}

}  // namespace

const char* name_of(Family family) {
    static constexpr const char* kNames[] = {"equal lags",      "spread lags",    "oscillating",  "inverse response",
                                             "integrating",     "drifting",       "sticky valve", "coarse sensor",
                                             "switched heater", "two time scales"};
    return kNames[static_cast<int>(family)];
}

double TruePlant::lag_sum() const {
    return std::accumulate(lags.begin(), lags.end(), 0.0) + (T_osc > 0 ? 2 * std::min(zeta, 1.0) * T_osc + T_osc : 0);
}

double TruePlant::settling() const {
    const double longest = lags.empty() ? 0 : *std::max_element(lags.begin(), lags.end());
    const double ringing = T_osc > 0 ? 3.5 * T_osc / std::min(zeta, 1.0) : 0;
    return L + std::max(2.5 * longest + 1.5 * lag_sum(), ringing);
}

Complex TruePlant::response(double omega) const {
    const Complex s(0, omega);
    Complex G = K * (1.0 + b * s) * std::exp(-L * s);
    for (const double T : lags) G /= 1.0 + T * s;
    if (T_osc > 0) G /= 1.0 + s * T_osc * (2 * zeta + s * T_osc);
    return integrating ? G / s : G;
}

Zpk TruePlant::zpk() const {
    Zpk plant{K, {}, {}, L, {}};
    if (b != 0) {
        plant.zeros.push_back(-1 / b);
        plant.K *= b;
    }
    for (const double T : lags) {
        plant.poles.push_back(-1 / T);
        plant.K /= T;
    }
    if (T_osc > 0) {
        const Complex pole = Complex(-zeta, std::sqrt(std::max(0.0, 1 - zeta * zeta))) / T_osc;
        plant.poles.push_back(pole);
        plant.poles.push_back(std::conj(pole));
        plant.K /= T_osc * T_osc;
    }
    if (integrating) plant.poles.push_back(0);
    return plant;
}

TruePlant make_plant(Family family, Random& random) {
    TruePlant plant;
    plant.family = family;
    plant.K = random.spread(0.02, 50) * (random.chance(0.25) ? -1 : 1);
    const double T = random.spread(1, 300);
    switch (family) {
        case Family::equal_lags: plant.lags.assign(static_cast<std::size_t>(1 + random.below(6)), T); break;
        case Family::spread_lags: spread_lags(plant, random); break;
        case Family::oscillating:
            plant.T_osc = T;
            plant.zeta = random.spread(0.1, 0.8);
            if (random.chance(0.5)) plant.lags = {T * random.uniform(0.1, 1)};
            break;
        case Family::inverse_response:
            plant.lags = {T, T * random.uniform(0.2, 1)};
            plant.b = -T * random.uniform(0.1, 1);
            break;
        case Family::integrating:
            plant.integrating = true;
            for (int k = random.below(3); k >= 0; --k) plant.lags.push_back(T * random.uniform(0.2, 1));
            break;
        case Family::drifting:
            plant.lags.assign(static_cast<std::size_t>(1 + random.below(2)), T);
            plant.drift = random.uniform(-0.1, 0.1);
            break;
        case Family::sticky_valve:
            plant.lags.assign(static_cast<std::size_t>(1 + random.below(3)), T);
            plant.dead_band = random.uniform(0.005, 0.05);
            break;
        case Family::coarse_sensor:
            plant.lags = {T, T * random.uniform(0.05, 0.5)};
            plant.grid = random.spread(0.005, 0.1);
            break;
        case Family::switched_heater:
            plant.lags = {T, T * random.uniform(0.05, 0.3)};
            plant.switched_rows = 1 + random.below(4);
            break;
        case Family::two_time_scales: {
            const double slow = T * random.spread(4, 30), share = random.uniform(0.3, 0.9);
            plant.lags = {slow, T};
            plant.b = share * slow + (1 - share) * T;
            break;
        }
    }
    plant.L = some_dead_time(plant.T_osc > 0 ? T : plant.lag_sum(), random);
    return plant;
}

RunningPlant::RunningPlant(const TruePlant& plant, double step) {
    const int order = static_cast<int>(plant.lags.size()) + (plant.T_osc > 0 ? 2 : 0) + (plant.integrating ? 1 : 0);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(order, order);
    Eigen::VectorXd B = Eigen::VectorXd::Zero(order), output = Eigen::VectorXd::Zero(order);
    // A chain: each part's input is the output of the previous one; the first one's is u.
    int before = -1;
    auto feed = [&](int row, double gain) {
        if (before < 0)
            B[row] += gain;
        else
            A(row, before) += gain;
    };
    int at = 0;
    if (plant.integrating) {
        feed(at, 1);
        before = at++;
    }
    if (plant.T_osc > 0) {
        A(at, at + 1) = 1;
        A(at + 1, at) = -1 / (plant.T_osc * plant.T_osc);
        A(at + 1, at + 1) = -2 * plant.zeta / plant.T_osc;
        feed(at + 1, 1 / (plant.T_osc * plant.T_osc));
        before = at;
        at += 2;
    }
    for (const double T : plant.lags) {
        A(at, at) = -1 / T;
        feed(at, 1 / T);
        before = at++;
    }
    output[before] = plant.K;
    // (b s + 1) on the last state; its derivative has no direct part if the chain has two or more states.
    if (plant.b != 0) output += plant.K * plant.b * A.row(before).transpose();
    Eigen::MatrixXd augmented = Eigen::MatrixXd::Zero(order + 1, order + 1);
    augmented.topLeftCorner(order, order) = A * step;
    augmented.topRightCorner(order, 1) = B * step;
    const Eigen::MatrixXd transition = augmented.exp();
    A_ = transition.topLeftCorner(order, order);
    B_ = transition.topRightCorner(order, 1);
    C_ = output;
    x_ = Eigen::VectorXd::Zero(order);
    delayed_.assign(static_cast<std::size_t>(std::lround(plant.L / step)), 0.0);
}

double RunningPlant::advance(double u, double load) {
    delayed_.push_back(u);
    x_ = A_ * x_ + B_ * (delayed_.front() + load);
    delayed_.pop_front();
    return C_.dot(x_);
}

double on_grid(double y, double grid) { return grid > 0 ? grid * std::round(y / grid) : y; }

ActuatedPlant::ActuatedPlant(const TruePlant& plant, double dt)
    : plant_(plant, dt / kFine), dead_band_(plant.dead_band), period_(kFine * plant.switched_rows) {}

double ActuatedPlant::advance(double u, double load) {
    double in = u;
    if (dead_band_ > 0) {
        if (std::abs(u - valve_) > dead_band_) valve_ = u - std::copysign(0.5 * dead_band_, u - valve_);
        in = valve_;
    }
    if (period_ > 0) {
        // The duty, -2 to 2 for always off and always on, is switched between the two levels; its mean over this step.
        const double from = static_cast<double>(steps_ % period_), duty = period_ * (2 + u) / 4;
        in = std::abs(u) < 2 ? 4 * std::clamp(duty - from, 0.0, 1.0) - 2 : u;
    }
    ++steps_;
    return y_ = plant_.advance(in, load);
}

}  // namespace tunewright::records
