#include "engine/simulation/linear/response_recorder.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/cubic.h"

namespace tunewright {
namespace {

constexpr double kNodeTolerance = 1e-7;  // of the cubic between nodes, relative to the largest value so far
constexpr int kMaxPieces = 16;

/// Error of the cubic through both ends of a part, at its midpoint.
double miss(const StepPolynomial& p, double from, double to) {
    const double h = (to - from) * p.h;
    const double cubic = hermite_midpoint(h, {p.at(from), p.slope(from)}, {p.at(to), p.slope(to)});
    return std::abs(p.at(0.5 * (from + to)) - cubic);
}

}  // namespace

ResponseRecorder::ResponseRecorder(NonlinearResponse& response, const NonlinearOptions& options, double r)
    : response_(response),
      keeps_nodes_(options.nodes),
      samples_(options.horizon ? options.samples : 0),
      horizon_(options.horizon.value_or(0)),
      r_(r),
      largest_y_(std::abs(r)) {
    if (keeps_nodes_) response.loop.nodes.reserve(512);
    response.even.y.reserve(std::size_t(samples_));
    response.even.u.reserve(std::size_t(samples_));
}

void ResponseRecorder::push_node(const StepPolynomial& y, const StepPolynomial& u, double s) {
    response_.loop.nodes.push_back({.t = y.t + s * y.h,
                                    .y = y.at(s),
                                    .y_slope = y.slope(s),
                                    .u = u.at(s),
                                    .u_slope = u.slope(s),
                                    .error_integral = error_integral_ + r_ * s * y.h - y.integral(s)});
}

int ResponseRecorder::pieces(const StepPolynomial& y, const StepPolynomial& u) const {
    for (int n = 1; n < kMaxPieces; n *= 2) {
        bool close = true;
        for (int i = 0; i < n && close; ++i) {
            const double from = double(i) / n, to = double(i + 1) / n;
            close =
                miss(y, from, to) <= kNodeTolerance * largest_y_ && miss(u, from, to) <= kNodeTolerance * largest_u_;
        }
        if (close) return n;
    }
    return kMaxPieces;
}

void ResponseRecorder::add(const StepPolynomial& y, const StepPolynomial& u) {
    largest_y_ = std::max({largest_y_, std::abs(y.at(0)), std::abs(y.at(1))});
    largest_u_ = std::max({largest_u_, std::abs(u.at(0)), std::abs(u.at(1))});
    if (keeps_nodes_) {
        if (at_border_) push_node(y, u, 0);
        const int n = pieces(y, u);
        for (int i = 1; i <= n; ++i) push_node(y, u, double(i) / n);
    }
    at_border_ = false;
    // A value at the border of two steps belongs to the later step.
    auto& [even_y, even_u] = response_.even;
    while (int(even_y.size()) < samples_) {
        const double s = (horizon_ * double(even_y.size()) / (samples_ - 1) - y.t) / y.h;
        if (!(s < 1)) break;
        even_y.push_back(y.at(s));
        even_u.push_back(u.at(s));
    }
    error_integral_ += r_ * y.h - y.integral(1);
}

void ResponseRecorder::finish(double t, double y, double u) {
    auto& [even_y, even_u] = response_.even;
    if (int(even_y.size()) + 1 != samples_ || t < horizon_) return;
    even_y.push_back(y);
    even_u.push_back(u);
}

}  // namespace tunewright
