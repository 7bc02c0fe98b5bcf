// The programs of products, each written only from its maker's published difference equation: the input is the texts
// typed for its parameters, the output is its response to a measurement, sample for sample. The set point is 0 and
// every value a deviation from the operating point; times in seconds, spans as sizes.
#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace tunewright::test {

/// The settings of a controller.
struct Typed {
    std::map<std::string, std::string> text;
    double Ts = 0;          ///< s; sample time of the program
    double Sy = 1, Su = 1;  ///< spans

    double number(const std::string& name) const { return std::stod(text.at(name)); }
    double number(const std::string& name, double fallback) const {
        return text.contains(name) ? number(name) : fallback;
    }
    bool is(const std::string& name, const std::string& word) const {
        const auto found = text.find(name);
        return found != text.end() && found->second == word;
    }
};

using OwnProgram = std::function<double(double y)>;

/// D = Kd d/dt of x through a first-order lag, by backward Euler.
class BackwardDerivative {
public:
    BackwardDerivative(double Kd, double Tf, double Ts) : Kd_(Kd), Tf_(Tf), Ts_(Ts) {}
    double operator()(double x) {
        D_ = (Tf_ * D_ + Kd_ * (x - last_)) / (Tf_ + Ts_);
        last_ = x;
        return D_;
    }

private:
    double Kd_, Tf_, Ts_, D_ = 0, last_ = 0;
};

// Position algorithms that add the complete error at the sample at which it is read (backward Euler), D of -PV or of
// the error, which is the same with a constant set point.
inline OwnProgram summing(double Kp, double Ki, double Kd, double Tf, double Ts) {
    return [=, I = 0.0, D = BackwardDerivative(Kd, Tf, Ts)](double y) mutable {
        I += Ki * Ts * -y;
        return Kp * -y + I + D(-y);
    };
}

// P + integral by the trapezoidal rule + plain difference: OSCAT (FT_INT), LabVIEW (PID.vi).
inline OwnProgram trapezoidal_sum(double Kp, double Ki, double Kd, double Ts) {
    return [=, I = 0.0, last = 0.0](double y) mutable {
        const double e = -y;
        I += Ki * Ts * (e + last) / 2;
        const double u = Kp * e + I + Kd * (e - last) / Ts;
        last = e;
        return u;
    };
}

// dCV = Kp dE + Ki E dt + Kd d2(-PV)/dt: PIDE and Yokogawa's fieldbus block. `change_of_error`: the change of E for P,
// in both cases of the measurement alone (the set point is constant).
inline OwnProgram velocity(double Kp, double Ki, double Kd, double Ts) {
    return [=, u = 0.0, y1 = 0.0, y2 = 0.0](double y) mutable {
        u += -Kp * (y - y1) - Ki * y * Ts - Kd * (y - 2 * y1 + y2) / Ts;
        y2 = y1;
        y1 = y;
        return u;
    };
}

// Mitsubishi FNC 88: dMV = KP [ (EV_n - EV_n-1) + (TS/TI) EV_n + D_n ], D_n = TD/(TS + KD TD) (-2 PV_n-1 + PV_n +
// PV_n-2) + KD TD/(TS + KD TD) D_n-1, for backward action with the sign of -PV.
inline OwnProgram mitsubishi(const Typed& typed) {
    const double KP = typed.number("KP") / 100, TI = typed.number("TI") / 10, TD = typed.number("TD") / 100,
                 KD = typed.number("KD", 0) / 100, TS = typed.number("TS") / 1000;
    const double action = typed.is("ACT_bit0", "0") ? 1 : -1;  // forward: PV - SV
    return [=, MV = 0.0, D = 0.0, PV1 = 0.0, PV2 = 0.0, Sy = typed.Sy, Su = typed.Su](double y) mutable {
        const double PV = y / Sy;
        D = TD / (TS + KD * TD) * (PV - 2 * PV1 + PV2) + KD * TD / (TS + KD * TD) * D;
        MV += KP * action * ((PV - PV1) + (TI > 0 ? TS / TI * PV : 0) + D);
        PV2 = PV1;
        PV1 = PV;
        return MV * Su;
    };
}

// DeltaV: OUT = GAIN (...) + F, the integral is a lag of time RESET around the output without the excluded part: the
// derivative in FORM Standard, none in FORM Series.
inline OwnProgram deltav(const Typed& typed, bool series) {
    const double GAIN = typed.number("GAIN"), RESET = typed.number("RESET"), RATE = typed.number("RATE"),
                 ALPHA = typed.number("ALPHA", 0.125), Ts = typed.Ts;
    const double action = typed.is("Direct_Acting", "true") ? -1 : 1;
    return [=, F = 0.0, lead = 0.0, D = BackwardDerivative(RATE, ALPHA * RATE, Ts), last = 0.0, Sy = typed.Sy,
            Su = typed.Su](double y) mutable {
        const double e = -action * 100 * y / Sy;
        double proportional = GAIN * e, derivative = 0;
        if (series) {  // lead + ALPHA RATE dlead/dt = e + RATE de/dt
            lead = (ALPHA * RATE * lead + (Ts + RATE) * e - RATE * last) / (Ts + ALPHA * RATE);
            proportional = GAIN * lead;
        } else {
            derivative = GAIN * D(e);
        }
        last = e;
        // F + RESET dF/dt = proportional + F at the new sample.
        const double a = Ts / (RESET + Ts);
        F = ((1 - a) * F + a * proportional) / (1 - a);
        return (proportional + derivative + F) * Su / 100;
    };
}

// OpenPLC, matiec: INTEGRAL XOUT += XIN CYCLE; DERIVATIVE XOUT = (3 (XIN - X3) + X1 - X2)/(10 CYCLE).
inline OwnProgram openplc(const Typed& typed) {
    const double KP = typed.number("KP"), TR = typed.number("TR"), TD = typed.number("TD"),
                 CYCLE = typed.number("CYCLE_s");
    return [=, ITERM = 0.0, X1 = 0.0, X2 = 0.0, X3 = 0.0](double y) mutable {
        const double ERROR = y;  // PV - SP
        ITERM += ERROR * CYCLE;
        const double DTERM = (3 * (ERROR - X3) + X1 - X2) / (10 * CYCLE);
        X3 = X2;
        X2 = X1;
        X1 = ERROR;
        return KP * (ERROR + ITERM / TR + DTERM * TD);
    };
}

// MATLAB's discrete pid: Kp + Ki Ts/(z - 1) + Kd/(Tf + Ts/(z - 1)), states one sample behind.
inline OwnProgram forward_euler(double Kp, double Ki, double Kd, double Tf, double Ts) {
    return [=, sum = 0.0, lag = 0.0](double y) mutable {
        const double e = -y;
        const double D = Tf > 0 ? Kd * (e - lag) / Tf : 0;
        const double u = Kp * e + Ki * sum + D;
        sum += Ts * e;
        if (Tf > 0) lag += Ts * (e - lag) / Tf;
        return u;
    };
}

/// num(z)/den(z) in ascending powers, applied to -y.
class DirectForm {
public:
    DirectForm(std::vector<double> num, std::vector<double> den)
        : num_(std::move(num)), den_(std::move(den)), in_(num_.size(), 0.0), out_(den_.size(), 0.0) {}
    double operator()(double x) {
        in_.push_front(x);
        in_.pop_back();
        double sum = 0;
        for (std::size_t i = 0; i < num_.size(); ++i) sum += num_[i] * in_[i];
        for (std::size_t i = 1; i < den_.size(); ++i) sum -= den_[i] * out_[i - 1];
        sum /= den_[0];
        out_.push_front(sum);
        out_.pop_back();
        return sum;
    }

private:
    std::vector<double> num_, den_;
    std::deque<double> in_, out_;
};

// ControlSystems.jl: pid(...) as a transfer function, c2d by Tustin as a whole. A separate integrator keeps its root on
// the circle: with w = (2/Ts)(z - 1)/(z + 1) for s, C = I Ts/2 (z + 1)/(z - 1) + R(s), or both times the filter.
inline OwnProgram tustin(const Typed& typed) {
    const double Kp = typed.number("param_p"), Ti = typed.number("param_i"), Td = typed.number("param_d", 0),
                 Tf = typed.number("Tf", 0), Ts = typed.Ts, w = 2 / Ts;
    const bool second = !typed.text.contains("filter_order") || typed.number("filter_order") == 2;
    // 1/(s Ti) + 1 + s Td/(1 + s Tf), or (1/(s Ti) + 1 + s Td)/(1 + s Tf + (s Tf)^2/2): D(s) s and N(s) by powers of s.
    const double n0 = 1 / Ti, n1 = 1 + (second ? 0 : Tf / Ti), n2 = second ? Td : Td + Tf;
    const double d0 = 1, d1 = Tf, d2 = second ? Tf * Tf / 2 : 0;
    DirectForm filter({n0 + n1 * w + n2 * w * w, 2 * n0 - 2 * n2 * w * w, n0 - n1 * w + n2 * w * w},
                      {d0 + d1 * w + d2 * w * w, 2 * d0 - 2 * d2 * w * w, d0 - d1 * w + d2 * w * w});
    // The remainder is 1/s: (Ts/2)(1 + z^-1)/(1 - z^-1).
    return [=, last = 0.0, sum = 0.0](double y) mutable {
        const double x = Kp * filter(-y);
        sum += Ts / 2 * (x + last);
        last = x;
        return sum;
    };
}

// Marlin: work_pid.Kd += PID_K2 (Kd/dT (prev - now) - work_pid.Kd), PID_K2 = 1 - PID_K1; integral of Ki dT.
inline OwnProgram marlin(const Typed& typed) {
    const double Kp = typed.number("P"), Ki = typed.number("I") * typed.Ts, Kd = typed.number("D") / typed.Ts,
                 K2 = 1 - typed.number("PID_K1", 0.95);
    return [=, sum = 0.0, D = 0.0, last = 0.0, Su = typed.Su](double y) mutable {
        D += K2 * (Kd * (last - y) - D);
        last = y;
        sum += -y;
        return (Kp * -y + Ki * sum + D) * Su / 255;
    };
}

// Klipper ControlPID: a derivative over time_diff, blended in over min_deriv_time = smooth_time.
inline OwnProgram klipper(const Typed& typed) {
    const double Kp = typed.number("pid_Kp") / 255, Ki = typed.number("pid_Ki") / 255,
                 Kd = typed.number("pid_Kd") / 255, dt = typed.Ts, smooth = typed.number("smooth_time", 1);
    return [=, integral = 0.0, slope = 0.0, last = 0.0, Su = typed.Su](double y) mutable {
        const double difference = y - last;
        slope = dt >= smooth ? difference / dt : (slope * (smooth - dt) + difference) / smooth;
        integral += -y * dt;
        last = y;
        return (Kp * -y + Ki * integral - Kd * slope) * Su;
    };
}

// RepRapFirmware, ESPHome: the slope of the measurement over M samples; ESPHome averages M slopes.
inline OwnProgram slopes(double Kp, double Ki, double Kd, int M, double Ts) {
    return [=, I = 0.0, last = 0.0, list = std::deque<double>(static_cast<std::size_t>(M), 0.0)](double y) mutable {
        list.push_back((y - last) / Ts);
        list.pop_front();
        last = y;
        double mean = 0;
        for (const double one : list) mean += one / M;
        I += -y * Ki * Ts;
        return Kp * -y + I - Kd * mean;
    };
}

// PX4: torque = P e + I - D dy/dt with the old integral, which is updated afterwards. DiscretePIDs.jl likewise, with
// its derivative by backward Euler.
inline OwnProgram late_integral(double Kp, double Ki, double Kd, double Tf, double Ts) {
    return [=, I = 0.0, D = BackwardDerivative(Kd, Tf, Ts)](double y) mutable {
        const double u = Kp * -y + I + D(-y);
        I += Ki * Ts * -y;
        return u;
    };
}

/// Cut-off in Hz to a time; 0 Hz: none.
inline double time_of_cutoff(double hz) { return hz > 0 ? 1 / (2 * std::numbers::pi * hz) : 0; }

OwnProgram own_program(const std::string& product, const Typed& typed);

}  // namespace tunewright::test
