#include "engine/loop/integral_sector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/loop/frequency_grid.h"
#include "engine/loop/stability.h"
#include "engine/numerics/fast_complex.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kGridStep = 0.1;  // minima between points are refined
constexpr int kGridDensity = 20;
constexpr int kMaxBeyond = 400;
constexpr double kStrideBeyond = 1.1;
constexpr double kCrossingTolerance = 1e-12;  // relative, of the frequency at which G is real

/// Popov's plane: x = Re G, y = omega Im G.
struct PopovPoint {
    double omega = 0, x = 0, y = 0;
};

class Sector {
public:
    Sector(const Loop& loop, const Loop& without_integral)
        : Ki_(loop.gains().Ki), pd_(without_integral), grid_(make_loop_grid(pd_, kGridStep, kGridDensity)) {
        for (const double omega : grid_.omega) points_.push_back(at(omega));
    }

    /// G = -j (Ki/omega) W with W = P/(1 + P C) of the PD loop.
    PopovPoint at(double omega) const {
        const std::complex<double> W = quotient(pd_.at(omega).T, pd_.controller({0, omega}));
        return {omega, Ki_ * W.imag() / omega, -Ki_ * W.real()};
    }

    bool residue_is_positive() const { return points_.front().y < 0; }

    /// Re (1 + j omega q) G > -1 for all omega.
    bool holds(double q) const {
        const auto f = [&](const PopovPoint& p) { return p.x - q * p.y; };
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const PopovPoint& p = points_[i];
            const bool resolved = p.omega <= grid_.resolved_to;
            if ((resolved ? f(p) : -bound(p.omega, q)) <= -1) return false;
            const bool inner = resolved && i > 0 && i + 1 < points_.size();
            if (!inner || f(p) > f(points_[i - 1]) || f(p) > f(points_[i + 1])) continue;
            const auto minus = [&](const PopovPoint& point) -> Maximum { return {point.omega, -f(point)}; };
            const Maximum before = minus(points_[i - 1]), here = minus(p), after = minus(points_[i + 1]);
            if (!may_exceed(1, before, here, after)) continue;
            const Maximum nearest = log_maximum([&](double omega) { return -f(at(omega)); }, before.x, here, after.x);
            if (nearest.value >= 1) return false;
        }
        return holds_beyond(q);
    }

    /// A q >= 0 for which all points of the grid satisfy the condition, with a margin if possible; empty: none.
    std::optional<double> candidate() const {
        double low = 0, high = kInfinity;
        for (const PopovPoint& p : points_) {
            if (p.omega > grid_.resolved_to) break;
            if (p.y > 0) high = std::min(high, (p.x + 1) / p.y);
            if (p.y < 0) low = std::max(low, (p.x + 1) / p.y);
            if (p.y == 0 && p.x <= -1) return std::nullopt;
        }
        if (low >= high) return std::nullopt;
        if (std::isfinite(high)) return 0.5 * (low + high);
        return low > 0 ? 2 * low : 0;
    }

    /// The crossings of the negative real axis by G beyond -1: factors below 1 of the integral gain at which the loop
    /// oscillates.
    void find_critical_gain(IntegralSector& sector) const {
        for (std::size_t i = 1; i < points_.size(); ++i) {
            if ((points_[i].y < 0) == (points_[i - 1].y < 0)) continue;
            const PopovPoint crossing = zero_of_y(points_[i - 1], points_[i]);
            if (crossing.x > -1) continue;
            const double k = -1 / crossing.x;
            if (sector.critical_gain && *sector.critical_gain >= k) continue;
            sector.critical_gain = k;
            sector.critical_omega = crossing.omega;
        }
    }

private:
    /// Above the grid G decreases, and so does the bound; without dead time the condition itself is checked up to
    /// there.
    bool holds_beyond(double q) const {
        double omega = points_.back().omega;
        for (int i = 0; i < kMaxBeyond; ++i, omega *= kStrideBeyond) {
            if (bound(omega, q) < 1) return true;
            const PopovPoint p = at(omega);
            if (pd_.plant().dead_time() > 0 || p.x - q * p.y <= -1) return false;
        }
        return false;
    }

    /// Bound of |G| and |omega q G| together, for frequencies at which the dead time turns faster than the grid
    /// resolves.
    double bound(double omega, double q) const {
        const double loop_gain = std::abs(pd_.open_loop({0, omega}));
        if (loop_gain >= 1) return kInfinity;
        return std::abs(Ki_) * (1 / omega + q) * std::abs(pd_.plant().at({0, omega})) / (1 - loop_gain);
    }

    PopovPoint zero_of_y(const PopovPoint& a, const PopovPoint& b) const {
        return at(
            log_root([this](double omega) { return at(omega).y; }, a.omega, b.omega, a.y, b.y, kCrossingTolerance));
    }

    double Ki_;
    const Loop& pd_;
    LoopGrid grid_;
    std::vector<PopovPoint> points_;
};

}  // namespace

IntegralSector judge_integral_sector(const Loop& loop) {
    IntegralSector result;
    ParallelPid gains = loop.gains();
    gains.Ki = 0;
    const auto without_integral = Loop::make(loop.plant(), gains);
    if (!without_integral) return result;
    result.stable_without_integral = count_unstable_poles(*without_integral).stable();
    const Sector sector(loop, *without_integral);
    sector.find_critical_gain(result);
    if (!result.stable_without_integral || !sector.residue_is_positive()) return result;
    result.stable_for_every_gain = !result.critical_gain;
    result.circle_criterion = sector.holds(0);
    if (result.circle_criterion) {
        result.popov_criterion = true;
        result.popov_q = 0;
        return result;
    }
    const auto q = sector.candidate();
    result.popov_criterion = q && sector.holds(*q);
    if (result.popov_criterion) result.popov_q = q;
    return result;
}

}  // namespace tunewright
