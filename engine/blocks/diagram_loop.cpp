#include "engine/blocks/diagram_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr double kNearZero = 1e-8;                           // of 1/time_scale: the low end of the axis
constexpr double kBelowCorners = 1e-3, kAboveCorners = 1e2;  // of the outermost corners
constexpr int kPointsPerDecade = 24;
constexpr double kGridStep = 0.1;  // change of S between neighbours
constexpr double kAtEnd = 1e-3;    // of S: the same from here to the end of the axis
constexpr int kMostDecades = 8;    // beyond the corners
// Turns of all dead times together: a slow outer loop has thousands of them below the peaks of a fast inner one.
constexpr double kTurnsResolved = 5000;

struct Band {
    double low = std::numeric_limits<double>::infinity(), high = 0;

    void add(double omega) {
        if (!(omega > 0) || !std::isfinite(omega)) return;
        low = std::min(low, omega);
        high = std::max(high, omega);
    }
};

Band band_of(const BlockDiagram& diagram) {
    Band band;
    band.add(1 / diagram.time_scale());
    for (const Block& block : diagram.blocks()) {
        for (const Complex pole : block.plant.poles()) band.add(std::abs(pole));
        for (const Complex zero : block.plant.zeros()) band.add(std::abs(zero));
        band.add(1 / block.plant.dead_time());
    }
    if (!(band.high > 0)) band.add(1);
    return {band.low * kBelowCorners, band.high * kAboveCorners};
}

}  // namespace

LoopPoint DiagramLoop::point(Complex s) const {
    const Complex S = diagram_->response(s, signal_)[signal_], T = 1.0 - S;
    return {T / S, S, T, 0};
}

LoopPoint DiagramLoop::at(double omega) const { return point({0, omega}); }

LoopGrid DiagramLoop::ends() const {
    LoopPoint slow = point(kNearZero / diagram_->time_scale());
    slow.L = slow.L.real();
    return {{0, std::numeric_limits<double>::infinity()}, {slow, {0, 1, 0, 0}}, 0};
}

LoopGrid make_loop_grid(const DiagramLoop& loop) {
    Band band = band_of(loop.diagram());
    for (int i = 0; i < kMostDecades && std::abs(loop.at(band.high).T) > kAtEnd; ++i) band.high *= 10;
    for (int i = 0; i < kMostDecades && std::abs(loop.at(band.low).S - loop.at(band.low / 10).S) > kAtEnd; ++i)
        band.low /= 10;
    const int n = static_cast<int>(std::ceil(kPointsPerDecade * std::log10(band.high / band.low)));
    std::vector<double> base;
    for (int i = 0; i <= n; ++i) base.push_back(band.low * std::pow(band.high / band.low, double(i) / n));
    const double dead_time = loop.turning_time();
    const double resolved_to = dead_time > 0 ? kTurnsResolved * 2 * std::numbers::pi / dead_time : base.back();
    return refined_grid([&](double omega) { return loop.at(omega); }, base, resolved_to, kGridStep);
}

}  // namespace tunewright
