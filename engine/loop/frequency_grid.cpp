#include "engine/loop/frequency_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/numerics/fast_complex.h"

namespace tunewright {
namespace {

constexpr std::size_t kMaxPoints = 20000;
constexpr double kTurnsResolved = 60;        // periods of e^(-jwL) that are followed one by one
constexpr std::size_t kUsualGrowth = 2;      // growth of a grid by refinement; memory is reserved for it
constexpr double kClosestNeighbours = 1e-7;  // relative distance below which no point is added

// Ratio of half an arc to its chord: 0.52 at a radian of dead time, and more because the rest of L turns too.
constexpr double kHalfOfArc = 0.55;

constexpr double kBelowCorners = 1e-3, kAboveCorners = 1e2;  // of the outermost corners: L is its asymptote beyond
constexpr double kAsymptoteBelowCorners = 1e-2,
                 kAsymptoteAboveCorners = 1e2;  // multiple of the corners at which the asymptotes are evaluated
constexpr double kMinAsymptoteSlope =
    0.1;  // slope of |L| in decades per decade: a flatter asymptote gives no reliable crossing
constexpr double kMaxLogCrossingDistance = 30;  // in ln omega from the frequency at which the asymptote is evaluated
constexpr double kLightDamping = 0.3;           // damping below which a pole or zero is a resonance
constexpr double kMinWidth = 1e-6;              // relative width of a resonance: an undamped one has none

using OpenLoop = std::function<std::complex<double>(double)>;

struct Range {
    double low, high;
};

void add_corner(std::vector<double>& corners, double omega) {
    if (std::isfinite(omega) && omega > 0) corners.push_back(omega);
}

/// Roots of Kd s^2 + Kp s + Ki: the frequencies between integral, proportional and derivative action.
void add_controller_corners(std::vector<double>& corners, const ParallelPid& c) {
    if (c.Kp != 0) add_corner(corners, std::abs(c.Ki / c.Kp));
    if (c.Kd != 0) add_corner(corners, std::abs(c.Kp / c.Kd));
    if (c.Kd != 0) add_corner(corners, std::sqrt(std::abs(c.Ki / c.Kd)));
    if (c.filter.type != FilterType::none) add_corner(corners, 1 / c.filter.Tf);
}

/// Frequencies at which the low- and high-frequency asymptotes of |L| cross one: a slow loop's crossover can lie far
/// below every corner.
void add_asymptote_crossings(std::vector<double>& corners, const OpenLoop& open_loop, double low, double high,
                             double highest) {
    const auto slope_crossing = [&](double omega, double ratio) {
        const double here = magnitude(open_loop(omega));
        const double there = magnitude(open_loop(omega * ratio));
        const double slope = std::log(there / here) / std::log(ratio);
        if (!std::isfinite(slope) || std::abs(slope) < kMinAsymptoteSlope) return 0.0;
        return omega * std::exp(std::clamp(-std::log(here) / slope, -kMaxLogCrossingDistance, kMaxLogCrossingDistance));
    };
    const double below = slope_crossing(low * kAsymptoteBelowCorners, 0.5);
    if (below < low) add_corner(corners, below);
    if (high * kAsymptoteAboveCorners > highest) return;
    const double above = slope_crossing(high * kAsymptoteAboveCorners, 2.0);
    if (above > high) add_corner(corners, above);
}

Range range_of(const LinearPlant& plant, const ParallelPid& gains, const OpenLoop& open_loop, double highest) {
    std::vector<double> corners;
    for (const auto zero : plant.zeros()) add_corner(corners, std::abs(zero));
    for (const auto pole : plant.poles()) add_corner(corners, std::abs(pole));
    if (plant.dead_time() > 0) add_corner(corners, 1 / plant.dead_time());
    add_controller_corners(corners, gains);
    if (corners.empty()) corners.push_back(1);
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
    const double first = std::min(*low, highest), last = *high;
    add_asymptote_crossings(corners, open_loop, first, last, highest);
    const auto [lower, higher] = std::minmax_element(corners.begin(), corners.end());
    return {std::min(*lower, highest) * kBelowCorners, std::min(*higher * kAboveCorners, highest)};
}

/// A point of the loop before it is added to the grid.
struct Candidate {
    Candidate(double omega, const LoopPoint& point) : omega(omega), point(point), square(std::norm(point.S)) {}

    double omega;
    LoopPoint point;
    double square;  // |S|^2, to avoid square roots
};

bool too_far(const Candidate& a, const Candidate& b, const Refinement& r) {
    if (std::norm(a.point.S - b.point.S) <= r.step * r.step * std::max(1.0, std::min(a.square, b.square))) return false;
    return r.enough_below == 0 || !(nearest_between(a.point.L, b.point.L) * r.enough_below > 1);
}

}  // namespace

double nearest_between(std::complex<double> from, std::complex<double> to) {
    return std::min(magnitude(1.0 + from), magnitude(1.0 + to)) - kHalfOfArc * magnitude(to - from);
}

std::vector<double> base_frequencies(const LinearPlant& plant, const ParallelPid& gains, const OpenLoop& open_loop,
                                     int density, double highest) {
    const Range range = range_of(plant, gains, open_loop, highest);
    const double decades = std::log10(range.high / range.low);
    const int n = std::max(2, static_cast<int>(std::ceil(decades * density)));
    std::vector<double> omega;
    omega.reserve(static_cast<std::size_t>(n) + 1);
    double next = range.low;
    for (const double ratio = std::pow(10.0, decades / n); omega.size() < static_cast<std::size_t>(n); next *= ratio)
        omega.push_back(next);
    omega.push_back(range.high);
    // A grid contains a lightly damped pole or zero only if a point is put there.
    const auto add_resonance = [&](std::complex<double> root) {
        if (root.imag() <= 0 || std::abs(root.real()) > kLightDamping * std::abs(root)) return;
        const double centre = std::abs(root), width = std::max(std::abs(root.real()), kMinWidth * centre);
        for (const double offset : {-3.0, -1.0, -0.3, 0.0, 0.3, 1.0, 3.0})
            if (centre + offset * width > 0 && centre + offset * width < highest)
                omega.push_back(centre + offset * width);
    };
    for (const auto pole : plant.poles()) add_resonance(pole);
    for (const auto zero : plant.zeros()) add_resonance(zero);
    std::sort(omega.begin(), omega.end());
    omega.erase(std::unique(omega.begin(), omega.end()), omega.end());
    return omega;
}

LoopGrid make_loop_grid(const Loop& loop, double step, int density) {
    const double L = loop.plant().dead_time();
    LoopGrid base{base_frequencies(
                      loop.plant(), loop.gains(),
                      [&](double omega) {
                          return loop.open_loop({0, omega});
                      },
                      density),
                  {},
                  0};
    base.point = loop.at(base.omega);
    base.resolved_to =
        L > 0 ? std::max(kTurnsResolved * 2 * std::numbers::pi / L, base.omega.front()) : base.omega.back();
    return refined_grid([&](double omega) { return loop.at(omega); }, base, step);
}

LoopGrid refined_grid(const std::function<LoopPoint(double)>& at, const std::vector<double>& base, double resolved_to,
                      const Refinement& refinement) {
    LoopGrid first{base, {}, resolved_to};
    first.point.reserve(base.size());
    for (const double omega : base) first.point.push_back(at(omega));
    return refined_grid(at, first, refinement);
}

LoopGrid refined_grid(const std::function<LoopPoint(double)>& at, const LoopGrid& base, const Refinement& refinement) {
    LoopGrid grid;
    grid.resolved_to = base.resolved_to;
    grid.omega.reserve(kUsualGrowth * base.omega.size());
    grid.point.reserve(kUsualGrowth * base.omega.size());
    const auto keep = [&grid](const Candidate& next) {
        grid.omega.push_back(next.omega);
        grid.point.push_back(next.point);
    };
    Candidate left(base.omega[0], base.point[0]);
    keep(left);
    // Between two base points: a stack of right ends. Intervals are halved (in log omega) until neighbours are close.
    std::vector<Candidate> waiting;
    for (std::size_t i = 1; i < base.omega.size(); ++i) {
        Candidate right(base.omega[i], base.point[i]);
        for (;;) {
            const bool may_refine = right.omega <= grid.resolved_to &&
                                    right.omega > left.omega * (1 + kClosestNeighbours) &&
                                    grid.omega.size() + waiting.size() < kMaxPoints;
            if (may_refine && too_far(left, right, refinement)) {
                waiting.push_back(right);
                const double middle = std::sqrt(left.omega * right.omega);
                right = Candidate(middle, at(middle));
                continue;
            }
            keep(right);
            left = right;
            if (waiting.empty()) break;
            right = waiting.back();
            waiting.pop_back();
        }
    }
    return grid;
}

}  // namespace tunewright
