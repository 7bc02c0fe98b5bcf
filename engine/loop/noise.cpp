#include "engine/loop/noise.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/loop/frequency_grid.h"
#include "engine/loop/margins.h"

namespace tunewright {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTolerance = 1e-6;   // of the whole integral, for all panels together
constexpr int kMaxDepth = 30;         // halvings of a panel; it is then shorter than rounding
constexpr double kSmallPower = 1e-9;  // |q|^k below which the rest of the series is negligible
constexpr double kSmallAngle = 1e-4;  // rad: up to it two terms of sinc^2 are accurate to rounding
constexpr double kFewLobes = 2;       // rad of omega Ts: shorter panels are smooth, longer ones need Filon's rule
constexpr int kMaxTail = 80;          // doublings of the last frequency

/// |C S|^2 without its high-frequency part.
class Remainder {
public:
    Remainder(const Loop& loop, double resolved_to)
        : loop_(loop),
          resolved_to_(loop.plant().dead_time() > 0 ? resolved_to : HUGE_VAL),
          end_gain_(loop.controller_high_frequency_gain()),
          q_(loop.signed_high_frequency_gain()) {}

    double operator()(double omega) const {
        const double L = loop_.plant().dead_time(), end = end_gain_ * end_gain_;
        if (omega > resolved_to_) {
            // Mean over a turn of the dead time: that of 1/|1 + L|^2 is 1/(1 - |L|^2).
            const double gain = std::abs(loop_.open_loop({0, omega}));
            if (gain < 1) return std::norm(loop_.controller({0, omega})) / (1 - gain * gain) - end / (1 - q_ * q_);
        }
        return std::norm(loop_.at(omega).CS) - end / std::norm(1.0 + q_ * std::polar(1.0, -omega * L));
    }

private:
    const Loop& loop_;
    double resolved_to_, end_gain_, q_;
};

/// The contribution of the high-frequency part to (sigma_u/sigma_n)^2.
double high_frequency_share(const Loop& loop, double Ts) {
    const double end = loop.controller_high_frequency_gain(), q = loop.signed_high_frequency_gain();
    const double L = loop.plant().dead_time();
    if (L == 0) return end * end / ((1 + q) * (1 + q));
    double sum = 1, power = -q;
    for (int k = 1; k * L < Ts && std::abs(power) > kSmallPower; ++k, power *= -q) sum += 2 * power * (1 - k * L / Ts);
    return end * end * sum / (1 - q * q);
}

double square_of_sinc(double x) {
    if (std::abs(x) < kSmallAngle) return 1 - x * x / 3;
    const double s = std::sin(x) / x;
    return s * s;
}

/// Integral of the remainder times sinc^2(omega Ts/2) over (a, b).
///
/// The rule for smooth panels is in Boost.Math; halving and Filon's rule are implemented here. On 200 random stable
/// loops, sampled at a tenth to 300 times their default interval, Boost's adaptive gauss_kronrod (15 points, the same
/// panels) gives the same figure to 8e-7 in 8 times the time, because it resolves every lobe; one such rule for each
/// panel is as fast as ours, with errors up to 5e-5; ooura_fourier_cos and _sin beyond omega = 1/Ts take 20 times as
/// long.
class Quadrature {
public:
    Quadrature(const Remainder& remainder, double Ts) : g_(remainder), Ts_(Ts) {}

    double adaptive(double a, double b, double tolerance) const {
        return refined(a, b, panel(a, b), tolerance, kMaxDepth);
    }

    double panel(double a, double b) const { return (b - a) * Ts_ > kFewLobes ? many_lobes(a, b) : smooth(a, b); }

private:
    double refined(double a, double b, double whole, double tolerance, int depth) const {
        const double middle = 0.5 * (a + b), left = panel(a, middle), right = panel(middle, b);
        if (std::abs(left + right - whole) <= tolerance || depth == 0) return left + right;
        return refined(a, middle, left, 0.5 * tolerance, depth - 1) +
               refined(middle, b, right, 0.5 * tolerance, depth - 1);
    }

    /// Gauss-Legendre, 4 points.
    template <class Function>
    static double gauss(double a, double b, const Function& f) {
        return boost::math::quadrature::gauss<double, 4>::integrate(f, a, b);
    }

    double smooth(double a, double b) const {
        return gauss(a, b, [&](double omega) { return g_(omega) * square_of_sinc(0.5 * omega * Ts_); });
    }

    /// sinc^2 = (1 - cos(omega Ts)) 2/(omega Ts)^2: the other factor is smooth, and its product with the cosine is
    /// integrated by Filon's rule (1928), which is exact for a parabola.
    double many_lobes(double a, double b) const {
        const auto f = [&](double omega) { return 2 * g_(omega) / (omega * Ts_ * omega * Ts_); };
        const double m = 0.5 * (a + b), H = 0.5 * (b - a), c = std::cos(H * Ts_), s = std::sin(H * Ts_);
        const double fa = f(a), fm = f(m), fb = f(b);
        const double f1 = (fb - fa) / (2 * H), f2 = (fa - 2 * fm + fb) / (2 * H * H);
        const double I0 = 2 * s / Ts_, J1 = 2 * (s / Ts_ - H * c) / Ts_,
                     I2 = 2 * (H * H * s + 2 * H * c / Ts_ - 2 * s / (Ts_ * Ts_)) / Ts_;
        const double with_cosine = std::cos(m * Ts_) * (fm * I0 + f2 * I2) - std::sin(m * Ts_) * f1 * J1;
        return gauss(a, b, f) - with_cosine;
    }

    const Remainder& g_;
    double Ts_;
};

}  // namespace

std::optional<double> noise_gain(const Loop& loop, double sample_time) {
    if (!std::isfinite(loop.controller_high_frequency_gain())) return std::nullopt;
    const double Ts = sample_time;
    const LoopGrid grid = make_loop_grid(loop);
    const Remainder remainder(loop, grid.resolved_to);
    const Quadrature quadrature(remainder, Ts);

    // Panels: 0 to the grid's start, where |C S| is flat; the grid; the corners of sinc; doublings beyond the grid.
    std::vector<double> edge = {0};
    for (const double omega : grid.omega) {
        for (const double lobe : {0.5 * kPi / Ts, 2 * kPi / Ts})
            if (edge.back() < lobe && lobe < omega) edge.push_back(lobe);
        edge.push_back(omega);
    }
    const double share = high_frequency_share(loop, Ts);
    double magnitude = share * kPi / Ts;
    for (std::size_t i = 1; i < edge.size(); ++i) magnitude += std::abs(quadrature.panel(edge[i - 1], edge[i]));
    const double tolerance = kTolerance * magnitude;
    double sum = 0;
    for (std::size_t i = 1; i < edge.size(); ++i)
        sum += quadrature.adaptive(edge[i - 1], edge[i], tolerance / static_cast<double>(edge.size()));
    double from = edge.back();
    for (int i = 0; i < kMaxTail; ++i, from *= 2) {
        // The remainder decreases at least like 1/omega^2, which bounds the integral beyond this frequency.
        const double beyond = from * std::abs(remainder(from)) * std::min(1.0, 4 / (from * Ts * from * Ts));
        if (beyond <= tolerance) break;
        sum += quadrature.adaptive(from, 2 * from, 0.1 * tolerance);
    }
    return std::sqrt(std::max(0.0, share + Ts / kPi * sum));
}

double default_noise_sample_time(const Loop& loop) {
    const Filter& filter = loop.gains().filter;
    if (filter.type != FilterType::none) return 0.1 * filter.Tf;
    const double crossover = find_margins(loop, make_loop_grid(loop)).gain_crossover;
    if (crossover > 0) return 0.01 * 2 * kPi / crossover;
    const double time = loop.plant().time_scale();
    return 0.01 * (time > 0 ? time : 1);
}

}  // namespace tunewright
