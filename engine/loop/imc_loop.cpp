#include "engine/loop/imc_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/loop/interior_margins.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr double kMaxRelativeChange =
    0.4;  // |D2 - D1| relative to the smaller: below it the change of the argument is unambiguous
constexpr int kMaxHalvings = 40;
constexpr double kMaxAxisDistance = 1e-9;  // |D|: closer to 0 counts as on the axis
constexpr double kTurnsResolved = 60;      // periods of the longer dead time that are resolved
constexpr int kPointsPerDecade = 24;

constexpr double kBelowCorners = 1e-3, kAboveCorners = 1e2;  // of the outermost corners
constexpr double kGridStep = 0.05;                           // change of S between neighbours
constexpr double kMinPeakRatio = 1 + 1e-12;  // a limit must exceed a peak by more than rounding to count as the peak

using Function = std::function<Complex(double)>;

double turn_between(const Function& D, double left, Complex D_left, double right, Complex D_right, int depth) {
    const double smaller = std::min(std::abs(D_left), std::abs(D_right));
    if (depth == 0 || std::abs(D_right - D_left) <= kMaxRelativeChange * smaller) return std::arg(D_right / D_left);
    const double middle = std::sqrt(left * right);
    const Complex D_middle = D(middle);
    return turn_between(D, left, D_left, middle, D_middle, depth - 1) +
           turn_between(D, middle, D_middle, right, D_right, depth - 1);
}

}  // namespace

LoopPoint ImcLoop::at(double omega) const {
    const Complex s(0, omega), P = plant_.at(s), G = controller_.model(s), Q = controller_.Q(s);
    const Complex D = 1.0 + (P - G) * Q, open = 1.0 - G * Q;
    return {P * Q / open, open / D, P * Q / D, Q / D};
}

Complex ImcLoop::characteristic(double omega) const {
    const Complex s(0, omega);
    return 1.0 + (plant_.at(s) - controller_.model(s)) * controller_.Q(s);
}

bool ImcLoop::stable() const {
    const Function D = [this](double omega) { return characteristic(omega); };
    const Complex start = D(0);
    if (!(start.real() > kMaxAxisDistance))
        return false;  // an odd number of turns: the gains of P(0) and the model differ in sign
    const double ratio = std::pow(10.0, 1.0 / kPointsPerDecade);
    double angle = 0, omega = lowest_corner() * kBelowCorners;
    Complex last = D(omega);
    angle += std::arg(last / start);
    // From here on P, G and Q decrease, so D stays near 1.
    const double end = kAboveCorners * highest_corner();
    while (omega < end) {
        const Complex next = D(omega * ratio);
        if (std::abs(next) < kMaxAxisDistance) return false;
        angle += turn_between(D, omega, last, omega * ratio, next, kMaxHalvings);
        omega *= ratio;
        last = next;
    }
    angle += std::arg(1.0 / last);
    return std::lround(angle / std::numbers::pi) == 0;
}

double ImcLoop::lowest_corner() const {
    double low = std::min(1 / controller_.lambda, 1 / controller_.tau);
    for (const auto pole : plant_.poles()) low = std::min(low, std::abs(pole));
    for (const auto zero : plant_.zeros()) low = std::min(low, std::abs(zero));
    return low;
}

double ImcLoop::highest_corner() const {
    double high = std::max(
        {1 / controller_.lambda, 1 / controller_.tau, controller_.beta != 0 ? 1 / std::abs(controller_.beta) : 0});
    for (const double L : {plant_.dead_time(), controller_.theta})
        if (L > 0) high = std::max(high, 1 / L);
    for (const auto pole : plant_.poles()) high = std::max(high, std::abs(pole));
    for (const auto zero : plant_.zeros()) high = std::max(high, std::abs(zero));
    return high;
}

LoopGrid ImcLoop::grid() const {
    const double low = lowest_corner() * kBelowCorners, high = highest_corner() * kAboveCorners;
    const int n = static_cast<int>(std::ceil(kPointsPerDecade * std::log10(high / low)));
    std::vector<double> base;
    for (int i = 0; i <= n; ++i) base.push_back(low * std::pow(high / low, static_cast<double>(i) / n));
    const double longest = std::max(plant_.dead_time(), controller_.theta);
    const double resolved_to = longest > 0 ? kTurnsResolved * 2 * std::numbers::pi / longest : base.back();
    return refined_grid([this](double omega) { return at(omega); }, base, resolved_to, kGridStep);
}

Peaks ImcLoop::peaks(const LoopGrid& grid) const {
    Peaks peaks = find_interior_peaks([this](double omega) { return at(omega); }, grid);
    const auto raise = [](Peak& peak, double value, double omega) {
        if (value > peak.value * kMinPeakRatio || (value >= peak.value && omega == 0)) peak = {value, omega};
    };
    const LoopPoint zero = at(0);
    raise(peaks.S, std::abs(zero.S), 0);
    raise(peaks.T, std::abs(zero.T), 0);
    raise(peaks.CS, std::abs(zero.CS), 0);
    const double infinity = std::numeric_limits<double>::infinity(), lambda = controller_.lambda;
    raise(peaks.S, 1, infinity);
    raise(peaks.CS, std::abs(controller_.beta * controller_.tau / (controller_.kp * lambda * lambda)), infinity);
    return peaks;
}

Margins ImcLoop::margins(const LoopGrid& grid) const {
    return find_interior_margins([this](double omega) { return at(omega).L; }, grid, plant_.dead_time());
}

}  // namespace tunewright
