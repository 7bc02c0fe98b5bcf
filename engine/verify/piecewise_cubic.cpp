#include "engine/verify/piecewise_cubic.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tunewright::verify {
namespace {

constexpr int kBisections = 60;  // beyond it a double has no more digits
// Gauss and Legendre's rule of five points on [0, 1], exact to degree 9: t |e| has 4, e^2 has 6.
constexpr std::array<double, 5> kNodes = {0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842,
                                          0.953089922969332};
constexpr std::array<double, 5> kWeights = {0.118463442528095, 0.239314335249683, 0.284444444444444, 0.239314335249683,
                                            0.118463442528095};

/// Times within (0, h) at which the cubic turns, ascending. Its coefficients are derivatives: value, slope, ...
std::vector<double> turns_of(const Cubic& c, double h) {
    std::vector<double> turns;
    const double a = c[3] / 2, b = c[2], d = c[1], under_root = b * b - 4 * a * d;
    if (under_root < 0) return turns;
    const double q = -0.5 * (b + std::copysign(std::sqrt(under_root), b));
    for (const double s : {q / a, d / q})
        if (s > 0 && s < h) turns.push_back(s);
    std::ranges::sort(turns);
    return turns;
}

}  // namespace

PiecewiseCubic::PiecewiseCubic(const std::vector<double>& t, const std::vector<Signal>& values)
    : first_(values.front().value), last_(values.back().value) {
    for (std::size_t i = 1; i < t.size(); ++i) {
        const double h = t[i] - t[i - 1];
        if (!(h > 0)) continue;
        const Cubic cubic = hermite_taylor(h, values[i - 1], values[i]);
        double from = 0;
        std::vector<double> ends = turns_of(cubic, h);
        ends.push_back(h);
        for (const double to : ends) {
            pieces_.push_back({t[i - 1] + from, to - from, from, cubic});
            from = to;
        }
    }
}

double PiecewiseCubic::Piece::crossing(double level) const {
    double low = 0, high = h;
    const bool rises = finish() > start();
    for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (low + high);
        ((at(middle) < level) == rises ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double PiecewiseCubic::max() const {
    double found = first_;
    for (const Piece& piece : pieces_) found = std::max({found, piece.start(), piece.finish()});
    return found;
}

double PiecewiseCubic::min() const {
    double found = first_;
    for (const Piece& piece : pieces_) found = std::min({found, piece.start(), piece.finish()});
    return found;
}

double PiecewiseCubic::variation() const {
    double sum = 0, before = 0;
    for (const Piece& piece : pieces_) {
        sum += std::abs(piece.start() - before) + std::abs(piece.finish() - piece.start());
        before = piece.finish();
    }
    return sum + std::abs(last_ - before);
}

std::optional<double> PiecewiseCubic::first_reached(double level) const {
    const double sign = level < 0 ? -1 : 1;
    for (const Piece& piece : pieces_) {
        if (sign * piece.start() >= sign * level) return piece.t;
        if (sign * piece.finish() >= sign * level) return piece.t + piece.crossing(level);
    }
    return std::nullopt;
}

std::optional<double> PiecewiseCubic::last_outside(double target, double band) const {
    if (std::abs(last_ - target) > band) return std::nullopt;
    for (auto piece = pieces_.rbegin(); piece != pieces_.rend(); ++piece) {
        if (std::abs(piece->finish() - target) > band) return piece->t + piece->h;
        const double start = piece->start();
        if (std::abs(start - target) > band)
            return piece->t + piece->crossing(target + std::copysign(band, start - target));
    }
    return 0;
}

PiecewiseCubic::ErrorIntegrals PiecewiseCubic::integrals(double target) const {
    ErrorIntegrals sums;
    const auto add = [&](const Piece& piece, double from, double to) {
        for (std::size_t k = 0; k < kNodes.size(); ++k) {
            const double s = from + (to - from) * kNodes[k], weight = (to - from) * kWeights[k],
                         e = target - piece.at(s);
            sums.error += weight * e;
            sums.absolute += weight * std::abs(e);
            sums.square += weight * e * e;
            sums.time_absolute += weight * (piece.t + s) * std::abs(e);
        }
    };
    for (const Piece& piece : pieces_) {
        const bool crosses = (piece.start() - target) * (piece.finish() - target) < 0;
        const double middle = crosses ? piece.crossing(target) : piece.h;
        add(piece, 0, middle);
        if (crosses) add(piece, middle, piece.h);
    }
    return sums;
}

}  // namespace tunewright::verify
