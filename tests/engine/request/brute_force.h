// The best settings of a product by brute force: settings on its own grid of numbers, evaluated by the test's own
// formulas.
#pragma once

#include <cstdio>
#include <optional>

#include "tests/engine/request/device_cases.h"

namespace tunewright::test {

inline constexpr double kWorse = 1.01;       // relative to the best by brute force
inline constexpr int kNet = 7, kRounds = 4;  // of the grid, and number of refinements

/// One plant with its hold, at frequencies from far below its corners to half the sampling frequency.
class Judge {
public:
    Judge(const Case& c, double Ts, double Ms, double Mt) : plant_(c.plant, Ts, 1), Ts_(Ts), Ms_(Ms), Mt_(Mt) {
        constexpr int kPoints = 220;
        const double low = 2e-4 * std::min(1.0, 30 * Ts / c.shortest);
        for (int i = 0; i <= kPoints; ++i) {
            angle_.push_back(std::numbers::pi * std::pow(low, 1 - static_cast<double>(i) / kPoints));
            P_.push_back(plant_.at(angle_.back()));
        }
    }

    /// True if |S| and |T| stay within the limits, by C(z) = sum of the increments z^-k/(1 - z^-1) after a pulse.
    bool within_limits(const OwnProgram& program) {
        increments(program);
        std::size_t at_S = 0, at_T = 0;
        double S = 0, T = 0;
        for (std::size_t i = 0; i < angle_.size(); ++i) {
            const std::complex<double> L = P_[i] * C(angle_[i]);
            const double s = 1 / std::abs(1.0 + L), t = s * std::abs(L);
            if (s > S) {
                S = s;
                at_S = i;
            }
            if (t > T) {
                T = t;
                at_T = i;
            }
            if (s > Ms_ * kHolds || t > Mt_ * kHolds) return false;
        }
        return refined(at_S, false) <= Ms_ * kHolds && refined(at_T, true) <= Mt_ * kHolds;
    }
    /// 1/Ki: a lower bound of the load IAE, for the program that was checked last.
    double min_iae() const { return Ts_ / std::abs(rest_); }
    double iae(const OwnProgram& program, double enough) const {
        OwnLoopPlant plant = plant_;
        return own_load_iae(plant, program, 400000, enough);
    }

private:
    static constexpr double kHolds = 1 + 1e-6;

    // u settles at increments of -Ki Ts, once filter and slopes have forgotten the pulse.
    void increments(OwnProgram program) {
        steps_.clear();
        double last = 0, largest = 0;
        for (int k = 0, quiet = 0; k < 4000 && (k < 64 || quiet < 16); ++k) {
            const double u = -program(k == 0 ? 1 : 0), move = u - last;
            last = u;
            largest = std::max(largest, std::abs(u));
            steps_.push_back(move);
            quiet = std::abs(move) < 1e-10 * largest ? quiet + 1 : 0;
        }
        while (steps_.size() > 2 && std::abs(steps_.back()) < 1e-12 * largest) steps_.pop_back();
        rest_ = last;
    }
    std::complex<double> C(double angle) const {
        const std::complex<double> step = std::polar(1.0, -angle);
        std::complex<double> sum = 0;
        for (auto one = steps_.rbegin(); one != steps_.rend(); ++one) sum = sum * step + *one;
        return sum / (1.0 - step);
    }
    double refined(std::size_t i, bool complementary) const {
        double a = std::log(angle_[i == 0 ? 0 : i - 1]), b = std::log(angle_[std::min(i + 1, angle_.size() - 1)]),
               best = 0;
        const auto value = [&](double x) {
            const std::complex<double> L = plant_.at(std::exp(x)) * C(std::exp(x));
            return (complementary ? std::abs(L) : 1) / std::abs(1.0 + L);
        };
        const double golden = (std::sqrt(5.0) - 1) / 2;
        for (int k = 0; k < 9; ++k) {
            const double x1 = b - golden * (b - a), x2 = a + golden * (b - a), v1 = value(x1), v2 = value(x2);
            best = std::max({best, v1, v2});
            (v1 > v2 ? b : a) = v1 > v2 ? x2 : x1;
        }
        return best;
    }

    OwnLoopPlant plant_;
    double Ts_, Ms_, Mt_;
    std::vector<double> angle_, steps_;
    std::vector<std::complex<double>> P_;
    double rest_ = 0;
};

/// Gain and times of a product's own form as its numbers, in the digits that it accepts.
struct Form {
    std::string gain, integral, derivative;
    double of_gain = 1;                         ///< number per K
    double of_integral = 1, of_derivative = 1;  ///< number per time in seconds, or per K/Ti and K Td
    enum class Kind { times, gains, band } kind = Kind::times;
    bool whole = false;
};

inline Form form_of(const std::string& product, const Case& c) {
    const double Sy = c.spans.y_high - c.spans.y_low, Su = c.spans.u_high - c.spans.u_low, q = Sy / Su, duty = 255 / Su;
    using enum Form::Kind;
    if (product == "siemens_pid_compact") return {"Gain", "Ti", "Td", 1, 1, 1, times};
    if (product == "rockwell_pide_independent") return {"PGain", "IGain", "DGain", q, 60 * q, q / 60, gains};
    if (product == "emerson_deltav_series") return {"GAIN", "RESET", "RATE", q, 1, 1, times};
    if (product == "klipper") return {"pid_Kp", "pid_Ki", "pid_Kd", duty, duty, duty, gains};
    if (product == "reprapfirmware") return {"P", "I", "D", duty, duty, duty, gains};
    if (product == "marlin") return {"P", "I", "D", duty, duty, duty, gains};
    if (product == "esphome_pid") return {"kp", "ki", "kd", 1 / Su, 1 / Su, 1 / Su, gains};
    if (product == "openplc_iec_pid") return {"KP", "TR", "TD", -1, 1, 1, times};  // its error is y - r
    if (product == "mitsubishi_fx_pid") return {"KP", "TI", "TD", 100 * q, 10, 100, times, true};
    if (product == "omron_pid190") return {"P", "Tik_0_1s", "Tdk_0_1s", 1000 / q, 10, 10, band, true};
    if (product == "foxboro_pid") return {"PBAND", "INT", "DERIV", 100 / q, 1.0 / 60, 1.0 / 60, band};
    if (product == "honeywell_interactive_b") return {"K", "T1", "T2", q, 1.0 / 60, 1.0 / 60, times};
    throw std::invalid_argument("brute_force: no form of " + product);
}

inline std::string four_digits(double x) {
    char text[40];
    if (x == 0) return "0.00";
    const int decimals = std::max(2, 3 - static_cast<int>(std::floor(std::log10(std::abs(x)))));
    std::snprintf(text, sizeof text, "%.*f", decimals, x);
    return text;
}

/// Brute-force search for settings: every (Ti, Td) of a coarse grid around the answer and of ever finer ones around the
/// best, with the largest gain within the limits and smaller ones.
class BruteForce {
public:
    BruteForce(std::string product, Form form, Typed answer, Judge judge)
        : product_(std::move(product)), form_(std::move(form)), answer_(std::move(answer)), judge_(std::move(judge)) {}

    std::function<void(Typed&)> tie = {};  ///< sets the filter's number if it follows from the derivative's

    struct Best {
        double IAE = std::numeric_limits<double>::infinity();
        Typed typed;
    };

    /// `net`: points per side of the coarse grid; `rounds`: number of finer ones.
    Best best(int net, int rounds) {
        read_answer();
        const double wide = std::log(6.0);
        std::vector<std::pair<double, double>> times;
        for (int i = 0; i < net; ++i)
            for (int j = 0; j <= net; ++j) {
                const double a = wide * (2.0 * i / (net - 1) - 1), b = wide * (2.0 * j / (net - 1) - 1);
                times.emplace_back(Ti_ * std::exp(a), j == net ? 0 : Td_ * std::exp(b));
            }
        for (const auto& [Ti, Td] : times) look(Ti, Td);
        double step = 2 * wide / (net - 1) / 2;
        look(Ti_, Td_);
        for (int round = 0; round < rounds; ++round, step /= 2) {
            const double Ti = best_Ti_, Td = best_Td_;
            for (int i = -2; i <= 2; ++i)
                for (int j = -2; j <= 2; ++j)
                    look(moved(Ti, i, step, form_.of_integral), moved(Td, j, step, form_.of_derivative));
        }
        return best_;
    }

private:
    double moved(double time, int i, double step, double per_second) const {
        const double factor = time * std::exp(i * step);
        if (!form_.whole) return factor;
        const double finest = std::max(0.0, std::round(time * per_second) + i) / per_second;
        return std::abs(factor - time) > std::abs(finest - time) ? factor : finest;
    }

    void read_answer() {
        const double g = answer_.number(form_.gain), i = answer_.number(form_.integral),
                     d = form_.derivative.empty() ? 0 : answer_.number(form_.derivative);
        K_ = form_.kind == Form::Kind::band ? form_.of_gain / g : g / form_.of_gain;
        const bool gains = form_.kind == Form::Kind::gains;
        Ti_ = best_Ti_ = gains ? K_ / (i / form_.of_integral) : i / form_.of_integral;
        Td_ = best_Td_ = gains ? d / form_.of_derivative / K_ : d / form_.of_derivative;
    }

    std::string number(double x) const { return form_.whole ? std::to_string(std::lround(x)) : four_digits(x); }

    Typed typed(double K, double Ti, double Td) const {
        Typed t = answer_;
        const bool gains = form_.kind == Form::Kind::gains;
        t.text[form_.gain] = number(form_.kind == Form::Kind::band ? form_.of_gain / K : K * form_.of_gain);
        t.text[form_.integral] = number(gains ? K / Ti * form_.of_integral : Ti * form_.of_integral);
        t.text[form_.derivative] = number(gains ? K * Td * form_.of_derivative : Td * form_.of_derivative);
        if (tie) tie(t);
        return t;
    }

    bool serves(double K, double Ti, double Td) {
        const Typed t = typed(K, Ti, Td);
        if (t.number(form_.integral) <= 0 || t.number(form_.gain) * form_.of_gain <= 0) return false;
        return judge_.within_limits(own_program(product_, t));
    }

    void look(double Ti, double Td) {
        double low = 0, high = 0;
        for (double K = 8 * K_; K > K_ / 30 && low == 0; K /= 1.3) {
            if (!serves(K, Ti, Td)) continue;
            if (judge_.min_iae() > best_.IAE) return;
            // Small |S| and |T| of an unstable loop are meaningless.
            const double bound = 1e4 * judge_.min_iae();
            if (!std::isfinite(judge_.iae(own_program(product_, typed(K, Ti, Td)), bound))) continue;
            low = K;
            high = K * 1.3;
        }
        if (low == 0) return;
        for (int i = 0; i < 12; ++i) {
            const double middle = std::sqrt(low * high);
            (serves(middle, Ti, Td) ? low : high) = middle;
        }
        for (const double share : {1.0, 0.97, 0.93, 0.85}) {
            const double K = share * low;
            if (!serves(K, Ti, Td) || judge_.min_iae() > best_.IAE * 1.0001) continue;
            const Typed t = typed(K, Ti, Td);
            const double IAE = judge_.iae(own_program(product_, t), 1.0001 * best_.IAE);
            if (!(IAE < best_.IAE)) continue;
            best_ = {IAE, t};
            best_Ti_ = Ti;
            best_Td_ = Td;
        }
    }

    std::string product_;
    Form form_;
    Typed answer_;
    Judge judge_;
    double K_ = 0, Ti_ = 0, Td_ = 0, best_Ti_ = 0, best_Td_ = 0;
    Best best_;
};

}  // namespace tunewright::test
