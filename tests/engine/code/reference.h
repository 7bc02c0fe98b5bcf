// The controller once more, written from its description with complete histories instead of states: the reference for
// the generated program, and calls of that program.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/code/algorithm.h"
#include "engine/code/interpreter.h"

namespace tunewright::code {

/// The program of one controller.
class Machine : public Interpreter {
public:
    using Interpreter::Interpreter;

    double step(double r, double y, bool manual = false, double manual_output = 0) {
        (*this)["setpoint"] = r;
        (*this)["measurement"] = y;
        (*this)["manual"] = manual ? 1 : 0;
        (*this)["manual_output"] = manual_output;
        call();
        return (*this)["u"];
    }
};

/// The settings that a user may change between two calls; gains with their sign.
struct Gains {
    double Kp = 0, Ki = 0, Kd = 0, b = 1;
};

class Reference {
public:
    Reference(const SampledPid& law, const CodeOptions& options, bool at_rest, double Tt)
        : law_(law), options_(options), at_rest_(at_rest), Tt_(Tt) {}

    double step(double r, double y, bool manual, double manual_output, const Gains& now) {
        if (r_.empty()) begin(r, y);
        r = (law_.gains.setpoint_lag * at(r_, 0) + law_.Ts * r) / (law_.gains.setpoint_lag + law_.Ts);
        measure(r, y);
        const double P = now.Kp * (now.b * r - at(yf_, 0)), D = now.Kd * at(slope_, 0);
        const double share = now.Ki * law_.Ts * fed();
        const double raw_before = last_sum(now);
        const bool given = manual || (first_ && !at_rest_ && law_.gains.Ki != 0);
        double u = 0;
        if (given) {
            u = limited(manual ? manual_output : options_.bias);
            level_ = u - P;
        } else if (law_.velocity) {
            // The last output and the increments of the sum; a given output contains no D.
            const double D_contained = given_last_ ? now.Kd * at(slope_, 1) : 0;
            u = rated(at(u_, 0) + (P + D - sum_before(now)) + D_contained + share);
            level_ = u - P - D;
        } else {
            level_ = raw_before;
            u = options_.anti_windup == AntiWindup::clamping ? clamped(P + D, share) : tracked(P + D, share, now.Ki);
        }
        gains_ = now;
        given_last_ = given;
        first_ = false;
        u_.push_back(u);
        return u;
    }

private:
    // The value `ago` calls back, 0 for the latest; before the first call `before`.
    static double at(const std::vector<double>& history, std::size_t ago) {
        return ago < history.size() ? history[history.size() - 1 - ago] : history.front();
    }

    void begin(double r, double y) {
        r_.assign(1, at_rest_ ? options_.y0 : r);
        yf_.assign(1, at_rest_ ? options_.y0 : y);
        f_.assign(1, law_.gains.c * r_[0] - yf_[0]);
        phi_.assign(1, phi(r_[0] - yf_[0]));
        slope_.assign(1, 0);
        u_.assign(1, options_.bias);
    }

    double phi(double e) const {
        return options_.delta_r ? std::exp(-0.5 * std::pow(e / *options_.delta_r, 2)) * e : e;
    }

    void measure(double r, double y) {
        const double Ts = law_.Ts, Tf = law_.gains.filter.Tf, before = at(yf_, 0);
        double now = y;
        if (law_.gains.filter.type == FilterType::measurement_first_order) now = (Tf * before + Ts * y) / (Tf + Ts);
        if (law_.gains.filter.type == FilterType::measurement_second_order) {
            v_ = (v_ + (2 * Ts / (Tf * Tf)) * (y - before)) / (1 + 2 * Ts / Tf + 2 * std::pow(Ts / Tf, 2));
            now = before + Ts * v_;
        }
        r_.push_back(r);
        yf_.push_back(now);
        f_.push_back(law_.gains.c * r - now);
        phi_.push_back(phi(r - now));
        slope_.push_back(slope());
    }

    // D divided by Kd, by the formulas of sampled_pid.h.
    double slope() const {
        const double Ts = law_.Ts, Tf = law_.gains.filter.Tf, step = at(f_, 0) - at(f_, 1), before = at(slope_, 0);
        const bool filtered = law_.gains.filter.type == FilterType::derivative;
        const auto M = static_cast<std::size_t>(law_.slope_samples);
        switch (law_.derivative) {
            case DerivativeRule::difference: return step / Ts;
            case DerivativeRule::filtered_backward: return filtered ? (Tf * before + step) / (Tf + Ts) : step / Ts;
            case DerivativeRule::filtered_forward: return filtered ? (1 - Ts / Tf) * before + step / Tf : step / Ts;
            case DerivativeRule::filtered_trapezoidal:
                return filtered ? ((2 * Tf - Ts) * before + 2 * step) / (2 * Tf + Ts) : step / Ts;
            case DerivativeRule::slope: return (at(f_, 0) - at(f_, M)) / (static_cast<double>(M) * Ts);
            case DerivativeRule::four_points:
                return (3 * at(f_, 0) + at(f_, 1) - at(f_, 2) - 3 * at(f_, 3)) / (10 * Ts);
        }
        return 0;
    }

    double fed() const {
        switch (law_.integral) {
            case IntegralRule::backward: return at(phi_, 0);
            case IntegralRule::forward: return at(phi_, 1);
            case IntegralRule::trapezoidal: return (at(phi_, 0) + at(phi_, 1)) / 2;
        }
        return 0;
    }

    // Proportional and derivative part of the last call with these gains.
    double sum_before(const Gains& gains) const {
        return gains.Kp * (gains.b * at(r_, 1) - at(yf_, 1)) + gains.Kd * at(slope_, 1);
    }

    // The level before this call: at the first call from the operating point, then such that the last sum is the same
    // with the current gains.
    double last_sum(const Gains& now) const {
        if (first_) return options_.bias - now.Kp * (now.b - 1) * options_.y0;
        return level_ + sum_before(gains_) - sum_before(now);
    }

    double limited(double u) const {
        return std::clamp(u, options_.u_min.value_or(-kNoLimit), options_.u_max.value_or(kNoLimit));
    }

    double rated(double u) const {
        if (options_.rate_limit > 0) {
            const double max = options_.rate_limit * law_.Ts;
            u = std::clamp(u, at(u_, 0) - max, at(u_, 0) + max);
        }
        return limited(u);
    }

    double clamped(double PD, double share) {
        const double raw = PD + level_ + share, u = rated(raw);
        if (u == raw || (raw > u) != (share > 0)) level_ += share;
        return rated(PD + level_);
    }

    double tracked(double PD, double share, double Ki) {
        level_ += share;
        const double raw = PD + level_, u = rated(raw);
        if (Ki != 0) level_ += std::min(1.0, law_.Ts / Tt_) * (u - raw);
        return u;
    }

    SampledPid law_;
    CodeOptions options_;
    bool at_rest_;
    double Tt_;
    bool first_ = true, given_last_ = false;
    double v_ = 0, level_ = 0;
    Gains gains_;
    std::vector<double> r_, yf_, f_, phi_, slope_, u_;
};

}  // namespace tunewright::code
