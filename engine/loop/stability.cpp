#include "engine/loop/stability.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/loop/delay_system.h"
#include "engine/loop/frequency_grid.h"
#include "engine/loop/winding.h"
#include "engine/numerics/fast_complex.h"
#include "engine/numerics/matrix/dense.h"
#include "engine/numerics/matrix/eigenvalues.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr int kMaxHalvings = 60;
constexpr double kMaxAxisDistance = 1e-9;  // |g| relative to its parts: a smaller value counts as a root on the axis

constexpr double kMaxModulusBelowOne = 0.99;  // of |L|: 1 + L stays in the right half-plane, with a margin for rounding
constexpr double kLargestSlope = 1.5;         // of the open loop's turn: below it the turn is less than a radian
constexpr double kGridStep = 0.5;        // change of S between neighbours: coarse, because each step's turn is checked
                                         // separately
constexpr int kGridDensity = 8;          // points a decade, for the same reason
constexpr int kSpareTurns = 6;           // turns of the dead time beyond those that the states can undo
constexpr double kMaxTailModulus = 0.3;  // of |L|: below it the rest of the axis does not turn 1 + L any further
constexpr double kMaxFrequencyRatio = 1e18;  // of the loop's own frequency: end of the search for a small |L|

/// g(jw) = (D + N e^(-jwL))/(jw + a)^n: bounded, never infinite, g -> 1 + L(infinity).
class Characteristic {
public:
    Characteristic(const Loop& loop, double a) : loop_(loop), a_(a), degree_(loop.denominator_degree()) {}

    struct Value {
        double omega;
        Complex g;
        Complex open;    // D/(jw + a)^n: g without the feedback, so g/open = 1 + L
        double size;     // sum of the magnitudes of the parts
        bool below_one;  // |L| is
    };
    Value at(double omega) const {
        const auto [numerator, denominator] = loop_.fraction({0, omega});
        Complex normaliser = 1;
        for (int i = 0; i < degree_; ++i) normaliser = product(normaliser, Complex(a_, omega));
        const Divisor normalised(normaliser);
        const Complex open = normalised.under(denominator), fed_back = normalised.under(numerator);
        const double of_open = magnitude(open), of_feedback = magnitude(fed_back);
        return {omega, open + fed_back, open, of_open + of_feedback, of_feedback < kMaxModulusBelowOne * of_open};
    }

private:
    const Loop& loop_;
    double a_;
    int degree_;
};

/// Follows g between two frequencies, halving the step until its turn is unambiguous. False: g is 0 there, or nearly 0.
bool follow(const Characteristic& g, Winding& winding, const Characteristic::Value& left,
            const Characteristic::Value& right, int depth = kMaxHalvings) {
    if (std::min(magnitude(left.g), magnitude(right.g)) <= kMaxAxisDistance * std::max(left.size, right.size))
        return false;
    if (Winding::is_short(left.g, right.g)) {
        winding.follow(right.g);
        return true;
    }
    if (depth == 0) return false;
    const auto centre = g.at(left.omega > 0 ? std::sqrt(left.omega * right.omega) : right.omega / 4);
    return follow(g, winding, left, centre, depth - 1) && follow(g, winding, centre, right, depth - 1);
}

/// If |L| < 1 from end to end, 1 + L stays in the right half-plane whatever the dead time.
bool follow_dead_time(Winding& winding, const Characteristic::Value& left, const Characteristic::Value& right) {
    if (left.omega == 0 || !left.below_one || !right.below_one) return false;
    const Complex open = quotient(right.open, left.open);
    if (!(std::abs(open.imag()) < kLargestSlope * open.real())) return false;
    if (Winding::is_short(left.g, right.g)) {
        winding.follow(right.g);
    } else {
        const Complex step = quotient(right.g, left.g);
        winding.turn(turn_of(step, open, quotient(step, open)), right.g);
    }
    return true;
}

/// Every turn of the dead time with |L| > 1 encircles -1 once, and the rational part can undo no more turns than it has
/// states. With far more turns the loop is unstable; the number of poles is then an estimate, and the turns need not be
/// followed one by one. Otherwise the result is 0.
int turns_outside_unit_circle(const Loop& loop, const LoopGrid& grid) {
    const double L = loop.plant().dead_time();
    for (std::size_t i = grid.omega.size(); L > 0 && i-- > 0;) {
        if (!(magnitude(grid.point[i].L) > 1)) continue;
        const double turns = grid.omega[i] * L / (2 * std::numbers::pi);
        return turns > loop.denominator_degree() + kSpareTurns ? static_cast<int>(std::min(2 * turns, 1e9)) : 0;
    }
    return 0;
}

/// States x and the history w_1..w_N of the delayed signal (w_0 = M x + N w_N is not free): x' = F x + G w_N, w_i' =
/// sum D_ij w_j.
std::vector<double> discretised(const DelaySystem& s, int nodes) {
    const int size = s.n + nodes;
    std::vector<double> A(static_cast<std::size_t>(size * size), 0.0);
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    using Vector = Eigen::VectorXd;
    const Eigen::MatrixXd D = chebyshev_differentiation(nodes, s.L);
    const auto d0 = D.col(0).tail(nodes);
    Eigen::Map<Matrix> whole(A.data(), size, size);
    whole.topLeftCorner(s.n, s.n) = Eigen::Map<const Matrix>(s.F.data(), s.n, s.n);
    whole.col(size - 1).head(s.n) += Eigen::Map<const Vector>(s.G.data(), s.n);
    whole.bottomLeftCorner(nodes, s.n).noalias() = d0 * Eigen::Map<const Vector>(s.M.data(), s.n).transpose();
    whole.bottomRightCorner(nodes, nodes) = D.bottomRightCorner(nodes, nodes);
    whole.col(size - 1).tail(nodes) += d0 * s.N;
    return A;
}

}  // namespace

StabilityCount count_unstable_poles(const Loop& loop) {
    const double L = loop.plant().dead_time(), q = loop.signed_high_frequency_gain();
    if (L > 0 && std::abs(q) >= 1) return {.unstable_poles = -1};

    const LoopGrid grid = make_loop_grid(loop, kGridStep, kGridDensity);
    if (const int many = turns_outside_unit_circle(loop, grid); many > 0) return {.unstable_poles = many};
    const double scale = std::sqrt(grid.omega.front() * grid.omega.back());
    const Characteristic g(loop, scale);
    auto left = g.at(0);
    if (magnitude(left.g) <= kMaxAxisDistance * left.size || left.size == 0)
        return {.unstable_poles = 0, .on_the_boundary = true};

    Winding winding(left.g);
    double omega = grid.omega.front();
    std::size_t next = 0;
    const Complex limit = L > 0 ? Complex(1) : Complex(1 + q);
    for (;;) {
        const auto right = g.at(omega);
        if (!follow_dead_time(winding, left, right) && !follow(g, winding, left, right))
            return {.unstable_poles = 0, .on_the_boundary = true};
        left = right;
        if (next + 1 < grid.omega.size()) {
            omega = grid.omega[++next];
            continue;
        }
        // Beyond the grid |L| (or q) must be small before the rest of the axis is taken in one step.
        const double rest = std::abs(loop.open_loop({0, omega}));
        if (rest < std::max(kMaxTailModulus, 0.5 * (1 + std::abs(q)) * (L > 0 ? 1 : 4)) ||
            omega > kMaxFrequencyRatio * scale)
            break;
        omega *= 10;
    }
    const double angle = winding.angle() + std::arg(limit / left.g);
    return {.unstable_poles = static_cast<int>(std::lround(-angle / std::numbers::pi))};
}

Expected<std::complex<double>> rightmost_pole(const Loop& loop, int nodes) {
    ParallelPid in_loop = loop.gains();
    in_loop.setpoint_lag = 0;  // the set-point filter is outside the loop
    const DelaySystem system = make_delay_system(loop.plant(), in_loop);
    std::vector<std::complex<double>> poles;
    if (system.L > 0) {
        poles = eigenvalues(discretised(system, nodes), system.n + nodes);
    } else {
        const DelaySystem closed = close_without_delay(system);
        poles = eigenvalues(closed.F, closed.n);
    }
    if (poles.empty())
        return Error{ErrorKind::numerical_failure, "",
                     "The poles of the loop cannot be computed: it has no states, or its numbers are out of range."};
    return *std::max_element(poles.begin(), poles.end(), [](auto a, auto b) { return a.real() < b.real(); });
}

}  // namespace tunewright
