#include "engine/loop/imc_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/loop/winding.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr int kMaxHalvings = 40;
constexpr double kMaxAxisDistance = 1e-9;  // |D|: closer to 0 counts as on the axis
constexpr double kTurnsResolved = 60;      // periods of the longer dead time that are resolved
constexpr int kPointsPerDecade = 24;

constexpr double kBelowCorners = 1e-3, kAboveCorners = 1e2;  // of the outermost corners
constexpr double kGridStep = 0.05;                           // change of S between neighbours

/// Follows D from one frequency to another, halving the step until its turn is unmistakable.
void follow(const ImcLoop& loop, Winding& winding, double left, Complex D_left, double right, Complex D_right,
            int depth = kMaxHalvings) {
    if (depth == 0 || Winding::is_short(D_left, D_right)) return winding.turn(std::arg(D_right / D_left), D_right);
    const double middle = std::sqrt(left * right);
    const Complex D_middle = loop.characteristic(middle);
    follow(loop, winding, left, D_left, middle, D_middle, depth - 1);
    follow(loop, winding, middle, D_middle, right, D_right, depth - 1);
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

LoopGrid ImcLoop::ends() const {
    const double lambda = controller_.lambda,
                 CS = controller_.beta * controller_.tau / (controller_.kp * lambda * lambda);
    return {{0, std::numeric_limits<double>::infinity()}, {at(0), {0, 1, 0, CS}}};
}

ImcLoop::Band ImcLoop::band() const {
    double low = std::min(1 / controller_.lambda, 1 / controller_.tau);
    double high = std::max(
        {1 / controller_.lambda, 1 / controller_.tau, controller_.beta != 0 ? 1 / std::abs(controller_.beta) : 0});
    for (const double L : {plant_.dead_time(), controller_.theta})
        if (L > 0) high = std::max(high, 1 / L);
    for (const auto& roots : {plant_.poles(), plant_.zeros()})
        for (const auto root : roots) {
            low = std::min(low, std::abs(root));
            high = std::max(high, std::abs(root));
        }
    return {low * kBelowCorners, high * kAboveCorners};
}

LoopGrid make_loop_grid(const ImcLoop& loop) {
    const auto [low, high] = loop.band();
    const int n = static_cast<int>(std::ceil(kPointsPerDecade * std::log10(high / low)));
    std::vector<double> base;
    for (int i = 0; i <= n; ++i) base.push_back(low * std::pow(high / low, static_cast<double>(i) / n));
    const double longest = loop.longest_dead_time();
    const double resolved_to = longest > 0 ? kTurnsResolved * 2 * std::numbers::pi / longest : base.back();
    return refined_grid([&](double omega) { return loop.at(omega); }, base, resolved_to, kGridStep);
}

StabilityCount count_unstable_poles(const ImcLoop& loop) {
    const Complex start = loop.characteristic(0);
    // Else an odd number of turns: P(0) and the model differ in sign.
    if (!(start.real() > kMaxAxisDistance)) return {.unstable_poles = 1};
    const double ratio = std::pow(10.0, 1.0 / kPointsPerDecade);
    const auto [low, end] = loop.band();
    Winding winding(start);
    Complex last = loop.characteristic(low);
    winding.turn(std::arg(last / start), last);
    for (double omega = low; omega < end; omega *= ratio) {
        const Complex next = loop.characteristic(omega * ratio);
        if (std::abs(next) < kMaxAxisDistance) return {.on_the_boundary = true};
        follow(loop, winding, omega, last, omega * ratio, next);
        last = next;
    }
    // P, G and Q have fallen below their corners: D stays near 1.
    const double angle = winding.angle() + std::arg(1.0 / last);
    return {.unstable_poles = static_cast<int>(std::lround(-angle / std::numbers::pi))};
}

}  // namespace tunewright
