#include "engine/numerics/step_polynomial.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace tunewright {
namespace {

constexpr double kBorderTolerance =
    8 * std::numeric_limits<double>::epsilon();  // of the time: a closer time counts as a step's border

using Matrix = std::array<std::array<double, 6>, 6>;

/// Row k has the contributions of value k to the six coefficients: Lagrange's polynomials multiplied out.
Matrix lagrange() {
    Matrix rows{};
    for (std::size_t k = 0; k < 6; ++k) {
        std::array<double, 6> p{1};
        std::size_t degree = 0;
        for (std::size_t j = 0; j < 6; ++j) {
            if (j == k) continue;
            const double scale = 1 / (kSixPoints[k] - kSixPoints[j]);
            for (std::size_t i = ++degree; i > 0; --i) p[i] = (p[i - 1] - kSixPoints[j] * p[i]) * scale;
            p[0] *= -kSixPoints[j] * scale;
        }
        rows[k] = p;
    }
    return rows;
}

}  // namespace

const std::array<double, 6> kSixPoints = [] {
    std::array<double, 6> s{};
    for (int k = 0; k < 6; ++k) s[std::size_t(k)] = 0.5 * (1 - std::cos(k * std::numbers::pi / 5));
    s.back() = 1;
    return s;
}();

StepPolynomial StepPolynomial::through(double t, double h, const std::array<double, 6>& values) {
    static const Matrix kLagrange = lagrange();
    StepPolynomial p{t, h, {}};
    for (std::size_t k = 0; k < 6; ++k)
        for (std::size_t i = 0; i < 6; ++i) p.c[i] += kLagrange[k][i] * values[k];
    return p;
}

void SignalHistory::add(const StepPolynomial& step) {
    steps_.push_back(step);
    supposed_.reset();
}

void SignalHistory::suppose_line(double time) {
    const StepPolynomial& last = steps_.back();
    supposed_ = StepPolynomial{time, last.h, {last.at(1), last.slope(1) * last.h}};
}

const StepPolynomial* SignalHistory::find(double time, bool before) const {
    const double slack = kBorderTolerance * std::abs(time);
    if (supposed_ && time > supposed_->t + slack) return &*supposed_;
    if (steps_.empty()) return nullptr;
    if (cursor_ >= steps_.size()) cursor_ = steps_.size() - 1;
    // The last step that begins before `time`, or at it if the value after a border is requested.
    const double latest_begin = before ? time - slack : time + slack;
    const auto begins_early = [&](std::size_t i) {
        return before ? steps_[i].t < latest_begin : steps_[i].t <= latest_begin;
    };
    while (cursor_ + 1 < steps_.size() && begins_early(cursor_ + 1)) ++cursor_;
    while (cursor_ > 0 && !begins_early(cursor_)) --cursor_;
    return begins_early(cursor_) ? &steps_[cursor_] : nullptr;
}

double SignalHistory::at(double time, bool before) const {
    const StepPolynomial* step = find(time, before);
    return step ? step->at((time - step->t) / step->h) : 0;
}

double SignalHistory::slope(double time, bool before) const {
    const StepPolynomial* step = find(time, before);
    return step ? step->slope((time - step->t) / step->h) : 0;
}

}  // namespace tunewright
