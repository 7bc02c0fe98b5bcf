#include "engine/loop/stability.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/loop/frequency_grid.h"
#include "engine/numerics/fast_complex.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr double kLargestTurn = 0.4;  // |g2 - g1| relative to the smaller: below it the argument cannot be mistaken
constexpr int kMaxHalvings = 60;
constexpr double kBoundary = 1e-9;  // |g| relative to its parts: closer to 0 counts as on the axis

/// g(jw) = (D + N e^(-jwL))/(jw + a)^n: bounded, never infinite, g -> 1 + L(infinity).
class Characteristic {
public:
    Characteristic(const Loop& loop, double a) : loop_(loop), a_(a), degree_(loop.denominator_degree()) {}

    struct Value {
        double omega;
        Complex g;
        Complex open;  // D/(jw + a)^n: g without the feedback, so g/open = 1 + L
        double size;   // sum of the magnitudes of the parts
    };
    Value at(double omega) const {
        auto [numerator, denominator] = loop_.fraction({0, omega});
        Complex normaliser = 1;
        for (int i = 0; i < degree_; ++i) normaliser *= Complex(a_, omega);
        return {omega, quotient(denominator + numerator, normaliser), quotient(denominator, normaliser),
                (magnitude(denominator) + magnitude(numerator)) / magnitude(normaliser)};
    }

private:
    const Loop& loop_;
    double a_;
    int degree_;
};

struct Turn {
    double angle = 0;
    bool boundary = false;
};

/// The change of arg g between two frequencies, halving the step until it is unmistakable.
Turn turn_between(const Characteristic& g, const Characteristic::Value& left, const Characteristic::Value& right,
                  int depth) {
    const double smaller = std::min(magnitude(left.g), magnitude(right.g));
    if (smaller <= kBoundary * std::max(left.size, right.size)) return {0, true};
    if (magnitude(right.g - left.g) <= kLargestTurn * smaller) return {std::arg(quotient(right.g, left.g)), false};
    if (depth == 0) return {std::arg(quotient(right.g, left.g)), true};
    const double middle = left.omega > 0 ? std::sqrt(left.omega * right.omega) : right.omega / 4;
    const auto centre = g.at(middle);
    const Turn first = turn_between(g, left, centre, depth - 1);
    if (first.boundary) return first;
    const Turn second = turn_between(g, centre, right, depth - 1);
    return {first.angle + second.angle, second.boundary};
}

/// Where |L| < 1 from end to end, 1 + L stays in the right half-plane however often the dead time turns it.
bool dead_time_cannot_encircle(const Characteristic::Value& value) {
    return magnitude(value.g - value.open) < 0.99 * magnitude(value.open);
}

Turn turn_of_step(const Characteristic& g, const Characteristic::Value& left, const Characteristic::Value& right) {
    if (left.omega > 0 && dead_time_cannot_encircle(left) && dead_time_cannot_encircle(right)) {
        const double open_turn = std::arg(quotient(right.open, left.open));
        if (std::abs(open_turn) < 1)
            return {std::arg(quotient(right.g, right.open)) - std::arg(quotient(left.g, left.open)) + open_turn, false};
    }
    return turn_between(g, left, right, kMaxHalvings);
}

/// Every turn of the dead time with |L| > 1 encircles -1 once, and the rational part can undo no more turns than it has
/// states. Far beyond that the loop is unstable; the number of poles is then an estimate, and nothing need be followed
/// turn by turn. Else 0.
int turns_outside_unit_circle(const Loop& loop, const LoopGrid& grid) {
    const double L = loop.plant().dead_time();
    for (std::size_t i = grid.omega.size(); L > 0 && i-- > 0;) {
        if (!(magnitude(grid.point[i].L) > 1)) continue;
        const double turns = grid.omega[i] * L / (2 * std::numbers::pi);
        return turns > loop.denominator_degree() + 6 ? static_cast<int>(std::min(2 * turns, 1e9)) : 0;
    }
    return 0;
}

}  // namespace

StabilityCount count_unstable_poles(const Loop& loop) {
    const double L = loop.plant().dead_time(), q = loop.signed_high_frequency_gain();
    if (L > 0 && std::abs(q) >= 1) return {.unstable_poles = -1};

    const LoopGrid grid = make_loop_grid(loop, 0.5, 8);
    if (const int many = turns_outside_unit_circle(loop, grid); many > 0) return {.unstable_poles = many};
    const double scale = std::sqrt(grid.omega.front() * grid.omega.back());
    const Characteristic g(loop, scale);
    auto left = g.at(0);
    const double start = left.g.real() < 0 ? std::numbers::pi : 0;
    if (magnitude(left.g) <= kBoundary * left.size || left.size == 0)
        return {.unstable_poles = 0, .on_the_boundary = true};

    double angle = start;
    double omega = grid.omega.front();
    std::size_t next = 0;
    const Complex limit = L > 0 ? Complex(1) : Complex(1 + q);
    for (;;) {
        const auto right = g.at(omega);
        const Turn turn = turn_of_step(g, left, right);
        if (turn.boundary) return {.unstable_poles = 0, .on_the_boundary = true};
        angle += turn.angle;
        left = right;
        if (next + 1 < grid.omega.size()) {
            omega = grid.omega[++next];
            continue;
        }
        // Past the grid |L| must be small (or q) before the rest of the axis is taken in one step.
        const double rest = std::abs(loop.open_loop({0, omega}));
        if (rest < std::max(0.3, 0.5 * (1 + std::abs(q)) * (L > 0 ? 1 : 4)) || omega > 1e18 * scale) break;
        omega *= 10;
    }
    angle += std::arg(limit / left.g);
    return {.unstable_poles = static_cast<int>(std::lround(-(angle - start) / std::numbers::pi))};
}

}  // namespace tunewright
