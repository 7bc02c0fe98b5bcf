#include "engine/blocks/diagram_stability.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/blocks/diagram_system.h"
#include "engine/loop/winding.h"
#include "engine/numerics/matrix/dense.h"
#include "engine/numerics/matrix/eigenvalues.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr double kAxisDistance = 1e-10;  // |g| relative to its size nearby: closer to 0 counts as on the axis
constexpr double kLowest = 1e-6;         // of the reference frequency: g hardly differs from its value at 0 there
constexpr double kFirstStep = 1.05, kMostGrowth = 1.5, kClosest = 1e-12;  // ratios of frequencies
constexpr double kTurnOfDeadTime = 0.5;  // rad of all dead times together in one step, while the loops have gain
constexpr double kSmallGain = 0.97;      // spectral radius of |M|: below 1 from there on, no factor 1 - M crosses 0
constexpr double kHigher = 1.6;          // ratio of the frequencies above at which the radius must stay below 1
constexpr int kMostHigher = 24;
constexpr int kMostSteps = 200'000;     // beyond that nothing is known, which counts as not stable
constexpr double kBetweenLooks = 1.5;   // ratio of the frequencies at which that radius is computed
constexpr double kBetweenTurns = 1.1;   // the same for the dead times that turn g
constexpr double kLittle = 0.05;        // share of g that a block contributes: its dead time turns nothing
constexpr double kNeutral = 1;          // the same of the direct terms
constexpr double kMostFrequency = 1e9;  // of the reference frequency
constexpr int kMostNewton = 40;
constexpr double kNearCancelled = 1e-4;  // of 1/time_scale

double spectral_radius(const Eigen::MatrixXd& A) {
    const auto n = static_cast<int>(A.rows());
    double largest = 0;
    for (const Complex value : eigenvalues({A.data(), static_cast<std::size_t>(A.size())}, n))
        largest = std::max(largest, std::abs(value));
    return largest;
}

/// g(jw) = det(I - M) prod den/(jw + a)^n: bounded, and it tends to det(I - M(infinity)).
class Curve {
public:
    Curve(const BlockDiagram& diagram, double right_of)
        : diagram_(diagram), a_(1 / diagram.time_scale()), right_of_(right_of * a_), order_(diagram.order()) {}

    double reference() const { return a_; }
    Complex at(Complex s) const { return diagram_.characteristic(s) / std::pow(s + a_, order_); }
    Complex at(double omega) const { return at(Complex(right_of_, omega)); }
    Complex start(double omega) const { return at(Complex(right_of_ + omega)); }
    bool gain_is_small(double omega) const {
        if (!(gain(omega) < kSmallGain)) return false;
        constexpr double kStillSmall = 0.5 * (1 + kSmallGain);
        for (const Block& block : diagram_.blocks())
            for (const Complex pole : block.plant.poles())
                if (std::abs(pole) > omega && !(gain(std::abs(pole)) < kStillSmall)) return false;
        for (int i = 0; i < kMostHigher; ++i)
            if (!(gain(omega *= kHigher) < kStillSmall)) return false;
        return true;
    }
    /// The dead times that turn g: a block of gain M from j to i contributes the share M H_ji. That of a slow outer
    /// loop is negligible over most of the frequencies of a fast inner one.
    double turning_dead_time(double omega) const {
        const Complex s(right_of_, omega);
        double sum = 0;
        for (const Block& block : diagram_.blocks())
            if (const double L = block.plant.dead_time(); L > 0)
                if (std::abs(block.plant.at(s) * diagram_.response(s, block.to)[block.from]) > kLittle) sum += L;
        return sum;
    }
    /// From a frequency with a small gain to infinity: each factor 1 - eigenvalue of M stays right of 0, so that it has
    /// turned back when M has become 0.
    double rest_of_turn(double omega) const {
        const Complex s(right_of_, omega), to_a = s + a_;
        double angle = 0;
        const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> of_M(Eigen::MatrixXcd(diagram_.connections(s)), false);
        for (const Complex value : of_M.eigenvalues()) angle += std::arg(1.0 - value);
        for (const Block& block : diagram_.blocks()) {
            if (block.cancelled) continue;
            for (int i = 0; i < block.plant.integrators(); ++i) angle += std::arg(s / to_a);
            for (const Complex pole : block.plant.poles()) angle += std::arg((s - pole) / to_a);
        }
        return -angle;
    }

private:
    double gain(double omega) const { return spectral_radius(diagram_.connections({right_of_, omega}).cwiseAbs()); }

    const BlockDiagram& diagram_;
    double a_, right_of_;
    int order_;
};

/// Follows the curve from one frequency to the next; false: it runs through 0.
bool follow(const Curve& g, Winding& winding, double left, Complex from, double right, Complex to) {
    if (std::min(std::abs(from), std::abs(to)) < kAxisDistance * std::max(std::abs(from), std::abs(to))) return false;
    const double middle = std::sqrt(left * right);
    const Complex between = g.at(middle);
    if (Winding::is_short(from, between) && Winding::is_short(between, to) && Winding::is_short(from, to)) {
        winding.follow(between);
        winding.follow(to);
        return true;
    }
    if (!(right > left * (1 + kClosest))) return false;
    return follow(g, winding, left, from, middle, between) && follow(g, winding, middle, between, right, to);
}

/// |direct terms| of the delayed blocks: with a radius of 1 or more infinitely many poles lie in the right half-plane.
bool is_neutral_and_unstable(const DiagramSystem& system) {
    const Eigen::Index count = Eigen::Index(system.delayed.size());
    Eigen::MatrixXd back(count, count);
    for (Eigen::Index k = 0; k < count; ++k) back.row(k) = system.N.row(system.delayed[std::size_t(k)].from).cwiseAbs();
    return count > 0 && spectral_radius(back) >= kNeutral;
}

}  // namespace

StabilityCount count_unstable_poles(const BlockDiagram& diagram, double right_of) {
    const auto system = make_system(diagram);
    if (!system || is_neutral_and_unstable(*system)) return {.unstable_poles = -1};
    const Curve g(diagram, right_of);
    const double reference = g.reference();
    if (!std::isfinite(reference)) return {};
    // At 0 itself integrators are infinite; the curve begins there on the real axis.
    double omega = kLowest * reference, next = kFirstStep * omega, ratio = kFirstStep;
    const Complex start = g.start(omega);
    Complex here = g.at(omega);
    if (!Winding::is_short(start, here)) return {.on_the_boundary = true};
    Winding winding(start);
    winding.follow(here);
    double looked_at = reference, turned_at = omega, dead_time = diagram.total_dead_time();
    int steps = 0;
    for (bool small = false; !small;) {
        if (++steps > kMostSteps) return {.unstable_poles = -1};
        const Complex there = g.at(next);
        if (!follow(g, winding, omega, here, next, there)) return {.on_the_boundary = true};
        omega = next;
        here = there;
        ratio = std::min(kMostGrowth, ratio * kFirstStep);
        next = omega * ratio;
        if (omega > kBetweenTurns * turned_at) {
            dead_time = g.turning_dead_time(omega);
            turned_at = omega;
        }
        if (dead_time > 0) next = std::min(next, omega + kTurnOfDeadTime / dead_time);
        if (omega > looked_at) {
            small = g.gain_is_small(omega);
            looked_at = kBetweenLooks * omega;
        }
        if (omega > kMostFrequency * reference) return {.unstable_poles = -1};
    }
    const double angle = winding.angle() + g.rest_of_turn(omega);
    return {.unstable_poles = static_cast<int>(std::lround(-angle / std::numbers::pi))};
}

namespace {

/// Each delayed signal by its values at the nodes of the time since it entered; the value at 0 is that of the system.
Eigen::MatrixXd discretised(const DiagramSystem& system, int nodes) {
    const Eigen::Index n = system.states(), count = Eigen::Index(system.delayed.size()), size = n + count * nodes;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size);
    A.topLeftCorner(n, n) = system.F;
    for (Eigen::Index k = 0; k < count; ++k) A.col(n + (k + 1) * nodes - 1).head(n) += system.G.col(k);
    for (Eigen::Index k = 0; k < count; ++k) {
        const auto& [from, L] = system.delayed[std::size_t(k)];
        const Eigen::MatrixXd D = chebyshev_differentiation(nodes, L);
        const Eigen::VectorXd of_start = D.col(0).tail(nodes);
        const Eigen::Index rows = n + k * nodes;
        A.block(rows, rows, nodes, nodes) += D.bottomRightCorner(nodes, nodes);
        A.block(rows, 0, nodes, n) += of_start * system.M.row(from);
        for (Eigen::Index j = 0; j < count; ++j)
            A.col(n + (j + 1) * nodes - 1).segment(rows, nodes) += of_start * system.N(from, j);
    }
    return A;
}

/// True near a pole that is none of the loops.
bool is_cancelled(const BlockDiagram& diagram, Complex pole) {
    for (const Block& block : diagram.blocks()) {
        if (!block.cancelled) continue;
        const double near = kNearCancelled / diagram.time_scale();
        if (block.plant.integrators() > 0 && std::abs(pole) < near) return true;
        for (const Complex own : block.plant.poles())
            if (std::abs(pole - own) < near) return true;
    }
    return false;
}

/// Newton's method on the characteristic function, with its slope from a difference; the start where it does not
/// converge.
Complex refined(const BlockDiagram& diagram, Complex start) {
    Complex s = start;
    const double scale = std::max(std::abs(start), 1e-6 / diagram.time_scale());
    for (int i = 0; i < kMostNewton; ++i) {
        const Complex h = 1e-6 * scale, value = diagram.characteristic(s);
        const Complex slope = (diagram.characteristic(s + h) - diagram.characteristic(s - h)) / (2.0 * h);
        const Complex step = value / slope;
        if (!std::isfinite(std::abs(step)) || std::abs(s - step - start) > 0.5 * scale) return start;
        s -= step;
        if (std::abs(step) < 1e-12 * scale) return s;
    }
    return start;
}

}  // namespace

Expected<Complex> rightmost_pole(const BlockDiagram& diagram, int nodes) {
    const auto system = make_system(diagram);
    if (!system) return system.error();
    const Eigen::MatrixXd A = discretised(*system, nodes);
    const auto poles = eigenvalues({A.data(), static_cast<std::size_t>(A.size())}, static_cast<int>(A.rows()));
    if (poles.empty())
        return Error{
            ErrorKind::numerical_failure, "",
            "The poles of the loops cannot be computed: they have no states, or their numbers are out of range."};
    Complex rightmost = -std::numeric_limits<double>::infinity();
    for (const Complex pole : poles)
        if (pole.real() > rightmost.real() && !is_cancelled(diagram, pole)) rightmost = pole;
    return refined(diagram, rightmost);
}

}  // namespace tunewright
