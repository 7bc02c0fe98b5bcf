#include "engine/verify/frequency_scan.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

namespace tunewright::verify {
namespace {

using Complex = std::complex<double>;
constexpr double kInfinity = std::numeric_limits<double>::infinity(), kPi = std::numbers::pi;

struct ScanLimits {
    double ratio = 1.003;          // of neighbouring frequencies: a resonance of damping 0.05 has thirty points
    double turn = 0.05;            // rad of the dead time between neighbours: a peak of |S| = 10 has four points
    double below = 1e-6;           // the first frequency over the lowest corner: limits at 0 are reached to 1e-12
    double above = 1e6;            // the last one over the highest corner, for limits at infinity
    double candidate_share = 0.7;  // of the largest value: a lower grid point cannot be beside the highest peak
    double equal = 1e-9;           // relative: two peaks are equally high
    double at_limit = 1e-11;       // relative: a limit of the axis is as high as the highest peak
    double same_gain = 1e-6;       // of |L| over a factor of 2 in omega: it has reached its limit
    double real_axis = 1e-4;       // rad: L at an end of the axis is real
    int max_points = 1'000'000;
};
constexpr ScanLimits kScan;
constexpr int kSectionings = 60, kBisections = 80;  // beyond them a double has no more digits

/// C(s) from u = -C y: the filter belongs to it.
Complex controller(const ParallelPid& pid, Complex s) {
    const Complex x = s * pid.filter.Tf;
    const Complex integral = pid.Ki != 0 ? pid.Ki / s : 0.0;
    switch (pid.filter.type) {
        case FilterType::none: return pid.Kp + integral + pid.Kd * s;
        case FilterType::derivative: return pid.Kp + integral + pid.Kd * s / (1.0 + x);
        case FilterType::measurement_first_order: return (pid.Kp + integral + pid.Kd * s) / (1.0 + x);
        case FilterType::measurement_second_order: return (pid.Kp + integral + pid.Kd * s) / (1.0 + x + 0.5 * x * x);
    }
    return 0;
}

struct ScanPoint {
    double omega = 0;
    Complex L, C;
    double S() const { return 1 / std::abs(1.0 + L); }
    double T() const { return std::abs(L) / std::abs(1.0 + L); }
    double CS() const { return std::abs(C) / std::abs(1.0 + L); }
};

using Quantity = double (ScanPoint::*)() const;

struct ScannedPeak {
    double value = 0;
    std::vector<double> omega;  ///< all frequencies with this value; infinite for the limit
};

class Scan {
public:
    Scan(const LinearPlant& plant, const ParallelPid& pid) : plant_(plant), pid_(pid) {
        note_corners();
        walk();
    }

    bool complete() const { return complete_; }
    ScannedPeak peak(Quantity of) const;
    Robustness figures(const GivenPeaks& given) const;

private:
    ScanPoint at(double omega) const {
        const Complex s(0, omega), C = controller(pid_, s);
        return {omega, plant_.at(s) * C, C};
    }
    void note_corners();
    void walk();
    bool turns_matter(const ScanPoint& point) const;
    void add_margins(Robustness& r) const;
    double bisect(double low, double high, const std::function<double(const ScanPoint&)>& of) const;
    double golden_section(double low, double high, Quantity of) const;

    const LinearPlant& plant_;
    ParallelPid pid_;
    double lowest_ = kInfinity, highest_ = 0;
    std::vector<double> extra_;  // frequencies around lightly damped roots
    std::vector<ScanPoint> points_;
    double S_ = 0, T_ = 0, CS_ = 0, negative_ = 0;  // largest so far; `negative_`: |L| < 1 on the negative real axis
    bool complete_ = true;
};

void Scan::note_corners() {
    const auto corner = [this](double omega) {
        if (!(omega > 0) || !std::isfinite(omega)) return;
        lowest_ = std::min(lowest_, omega);
        highest_ = std::max(highest_, omega);
    };
    for (const auto roots : {plant_.poles(), plant_.zeros()})
        for (const Complex root : roots) {
            corner(std::abs(root));
            if (!(root.imag() > 0)) continue;
            for (double part = 1e-3; part < 1e3; part *= 1.1)
                for (const double side : {-1.0, 1.0})
                    extra_.push_back(root.imag() + side * part * std::abs(root.real()));
            extra_.push_back(root.imag());
        }
    if (plant_.dead_time() > 0) corner(1 / plant_.dead_time());
    if (pid_.filter.type != FilterType::none) corner(1 / pid_.filter.Tf);
    if (pid_.Kp != 0) {
        corner(std::abs(pid_.Ki / pid_.Kp));
        if (pid_.Kd != 0) corner(std::abs(pid_.Kp / pid_.Kd));
    }
    if (pid_.Kd != 0 && pid_.Ki != 0) corner(std::sqrt(std::abs(pid_.Ki / pid_.Kd)));
    if (highest_ == 0) lowest_ = highest_ = 1;
    // Without corners of their own, integrators cross |L| = 1 anywhere.
    const bool integrates = plant_.integrators() > 0 || pid_.Ki != 0;
    for (int i = 0; i < 60 && integrates && std::abs(at(lowest_).L) < 1e3; ++i) lowest_ /= 10;
    for (int i = 0; i < 60 && plant_.pole_excess() > 0 && std::abs(at(highest_).L) > 1; ++i) highest_ *= 10;
    std::ranges::sort(extra_);
}

/// True while a turn of the dead time can raise a peak or lower a margin.
bool Scan::turns_matter(const ScanPoint& point) const {
    const double L = std::abs(point.L);
    if (L >= 1 || L > negative_) return L > 1e-7;
    const double envelope = 1 / (1 - L);
    return envelope > S_ || L * envelope > T_ || std::abs(point.C) * envelope > CS_ * (1 + kScan.equal);
}

void Scan::walk() {
    const double end = kScan.above * highest_, delay = plant_.dead_time();
    auto extra = extra_.begin();
    for (double omega = kScan.below * lowest_; omega < end;) {
        const ScanPoint point = at(omega);
        S_ = std::max(S_, point.S());
        T_ = std::max(T_, point.T());
        CS_ = std::max(CS_, point.CS());
        if (!points_.empty() && points_.back().L.imag() * point.L.imag() < 0 && point.L.real() < 0 &&
            std::abs(point.L) < 1)
            negative_ = std::max(negative_, std::abs(point.L.real()));
        points_.push_back(point);
        if (points_.size() > static_cast<std::size_t>(kScan.max_points)) {
            complete_ = false;
            return;
        }
        double next = omega * kScan.ratio;
        if (delay > 0 && (next - omega) * delay > kScan.turn && turns_matter(point)) next = omega + kScan.turn / delay;
        while (extra != extra_.end() && *extra <= omega) ++extra;
        if (extra != extra_.end() && *extra < next) next = *extra;
        omega = next;
    }
}

double Scan::golden_section(double low, double high, Quantity of) const {
    constexpr double kGolden = 1 / std::numbers::phi;
    double a = std::log(low), b = std::log(high);
    double left = b - kGolden * (b - a), right = a + kGolden * (b - a);
    double at_left = (at(std::exp(left)).*of)(), at_right = (at(std::exp(right)).*of)();
    for (int i = 0; i < kSectionings; ++i) {
        if (at_left > at_right) {
            b = right;
            right = left;
            at_right = at_left;
            left = b - kGolden * (b - a);
            at_left = (at(std::exp(left)).*of)();
        } else {
            a = left;
            left = right;
            at_left = at_right;
            right = a + kGolden * (b - a);
            at_right = (at(std::exp(right)).*of)();
        }
    }
    return std::exp(0.5 * (a + b));
}

ScannedPeak Scan::peak(Quantity of) const {
    const double first = (points_.front().*of)();
    double last = (points_.back().*of)();
    if (plant_.dead_time() > 0) {
        // The worst phase of the dead time at infinity.
        const ScanPoint& end = points_.back();
        const double L = std::abs(end.L);
        const ScanPoint worst{end.omega, -L, end.C};
        last = (worst.*of)();
    }
    double largest = std::max(first, last);
    for (const ScanPoint& point : points_) largest = std::max(largest, (point.*of)());
    std::vector<std::pair<double, double>> tops{{first, 0}, {last, kInfinity}};
    for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
        const double value = (points_[i].*of)();
        if (value < kScan.candidate_share * largest || value < (points_[i - 1].*of)() || value < (points_[i + 1].*of)())
            continue;
        const double omega = golden_section(points_[i - 1].omega, points_[i + 1].omega, of);
        tops.emplace_back((at(omega).*of)(), omega);
    }
    ScannedPeak found{std::ranges::max_element(tops)->first, {}};
    const bool at_end = std::max(first, last) >= found.value * (1 - kScan.at_limit);
    for (const auto& [value, omega] : tops) {
        const bool is_end = omega == 0 || omega == kInfinity;
        if (at_end ? is_end && value >= found.value * (1 - kScan.at_limit) : value >= found.value * (1 - kScan.equal))
            found.omega.push_back(omega);
    }
    return found;
}

double Scan::bisect(double low, double high, const std::function<double(const ScanPoint&)>& of) const {
    const bool rises = of(at(high)) > of(at(low));
    for (int i = 0; i < kBisections; ++i) {
        const double middle = std::sqrt(low * high);
        ((of(at(middle)) < 0) == rises ? low : high) = middle;
    }
    return std::sqrt(low * high);
}

void Scan::add_margins(Robustness& r) const {
    double gain = kInfinity, gain_low = 0, phase = kInfinity, delay = kInfinity, crossover = 0, real_at = 0;
    const auto note_real = [&](double real, double omega) {
        const double factor = -1 / real;
        if (factor > 1 && factor < gain) {
            gain = factor;
            real_at = omega;
        }
        if (factor < 1 && factor > gain_low) {
            if (gain == kInfinity) real_at = omega;
            gain_low = factor;
        }
    };
    for (std::size_t i = 1; i < points_.size(); ++i) {
        const ScanPoint &a = points_[i - 1], &b = points_[i];
        if ((std::abs(a.L) - 1) * (std::abs(b.L) - 1) < 0) {
            const double omega = bisect(a.omega, b.omega, [](const ScanPoint& p) { return std::log(std::abs(p.L)); });
            const double angle = std::arg(-at(omega).L), ahead = angle > 0 ? angle : angle + 2 * kPi;
            if (std::abs(angle) < phase) {
                phase = std::abs(angle);
                crossover = omega;
            }
            delay = std::min(delay, ahead / omega);
        }
        if (a.L.imag() * b.L.imag() < 0 && a.L.real() < 0 && b.L.real() < 0) {
            const double omega =
                bisect(a.omega, b.omega, [](const ScanPoint& p) { return p.L.imag() / std::abs(p.L); });
            note_real(at(omega).L.real(), omega);
        }
    }
    // L where it ends on the axis, or turns for ever.
    const auto settled = [&](const ScanPoint& end, double factor) {
        return std::abs(std::abs(at(end.omega * factor).L) / std::abs(end.L) - 1) < kScan.same_gain;
    };
    const ScanPoint &low = points_.front(), &high = points_.back();
    if (settled(low, 2) && std::abs(std::arg(-low.L)) < kScan.real_axis) note_real(-std::abs(low.L), 0);
    if (settled(high, 0.5) && (plant_.dead_time() > 0 || std::abs(std::arg(-high.L)) < kScan.real_axis))
        note_real(-std::abs(high.L), kInfinity);
    const std::string none = "The second method finds no crossing.";
    r.gain_margin = finite_or(gain, none);
    r.gain_margin_low = gain_low > 0 ? Figure(gain_low) : no_figure(none);
    r.phase_margin_deg = finite_or(phase * 180 / kPi, none);
    r.delay_margin = finite_or(delay, none);
    r.gain_crossover = r.phase_margin_deg ? Figure(crossover) : no_figure(none);
    r.phase_crossover = (r.gain_margin || r.gain_margin_low) ? finite_or(real_at, none) : no_figure(none);
    r.tolerates = {r.gain_margin_low.value_or(0), r.gain_margin, r.delay_margin};
}

double nearest(const std::vector<double>& all, const std::optional<double>& given) {
    const double wanted = given.value_or(kInfinity);
    double found = all.front();
    for (const double omega : all)
        if (omega == wanted || std::abs(omega - wanted) < std::abs(found - wanted)) found = omega;
    return found;
}

Robustness Scan::figures(const GivenPeaks& given) const {
    const std::string unbounded = "The second method finds no finite maximum.";
    Robustness r;
    r.stable = true;
    const ScannedPeak S = peak(&ScanPoint::S), T = peak(&ScanPoint::T), CS = peak(&ScanPoint::CS);
    r.Ms = finite_or(S.value, unbounded);
    r.omega_Ms = finite_or(nearest(S.omega, given.omega_Ms), unbounded);
    r.Mt = finite_or(T.value, unbounded);
    r.omega_Mt = finite_or(nearest(T.omega, given.omega_Mt), unbounded);
    const bool differentiates = pid_.Kd != 0 && pid_.filter.type == FilterType::none;
    r.Mks = differentiates ? no_figure(unbounded) : finite_or(CS.value, unbounded);
    add_margins(r);
    return r;
}

}  // namespace

Expected<Robustness> scan_frequencies(const LinearPlant& plant, const ParallelPid& pid, const GivenPeaks& given) {
    const Scan scan(plant, pid);
    if (!scan.complete())
        return Error{ErrorKind::unsupported, "",
                     "The dead time turns the loop gain too often for the second method's dense grid."};
    return scan.figures(given);
}

}  // namespace tunewright::verify
