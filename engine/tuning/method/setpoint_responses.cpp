#include "engine/tuning/method/setpoint_responses.h"

#include <algorithm>
#include <cmath>

#include "engine/simulation/linear/indices.h"

namespace tunewright {
namespace {

constexpr double kTolerance = 1e-5, kSettledTolerance = 1e-6;  // of the responses on which the choice depends
constexpr double kSameInstant = 1e-12;

/// Times closer than their rounding are equal.
bool jumps_after(const std::vector<ResponseNode>& nodes, std::size_t i) {
    return i + 1 < nodes.size() && nodes[i + 1].t - nodes[i].t <= kSameInstant * nodes[i + 1].t;
}

/// Doubles a node of one run where only the other run has a jump, over the same steps.
void align(std::vector<ResponseNode>& a, std::vector<ResponseNode>& b) {
    std::vector<ResponseNode> both_a, both_b;
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        both_a.push_back(a[i]);
        both_b.push_back(b[j]);
        const bool a_jumps = jumps_after(a, i), b_jumps = jumps_after(b, j);
        if (a_jumps || !b_jumps) ++i;
        if (b_jumps || !a_jumps) ++j;
    }
    a = std::move(both_a);
    b = std::move(both_b);
}

}  // namespace

SetpointResponses::SetpointResponses(const LinearPlant& plant, const IdealPid& pid) {
    ResponseOptions options;
    options.tolerance = kTolerance;
    options.settled = kSettledTolerance;
    IdealPid with = pid;
    with.setpoint_lag = 0;
    with.b = 1;
    StepResponse one = simulate_linear(plant, to_parallel(with), {1, 0}, options);
    with.b = 0;
    options.repeat = &one.schedule;
    zero_ = simulate_linear(plant, to_parallel(with), {1, 0}, options);
    align(one.nodes, zero_.nodes);
    usable_ = one.settles && one.nodes.size() == zero_.nodes.size();
    if (!usable_) return;
    IE_of_one_ = one.error_integral_final;
    added_ = std::move(one.nodes);
    for (std::size_t i = 0; i < added_.size(); ++i) {
        added_[i].y -= zero_.nodes[i].y;
        added_[i].y_slope -= zero_.nodes[i].y_slope;
        added_[i].error_integral -= zero_.nodes[i].error_integral;
    }
}

double SetpointResponses::time() const { return std::abs(zero_.error_integral_final.value_or(1)); }

double SetpointResponses::IAE(double b) const { return integral_of_absolute_error(weighted(b), 1, error_integral(b)); }

double SetpointResponses::percent_above(const std::vector<ResponseNode>& nodes) {
    return 100 * (extremes_of_y(nodes).max - 1);
}

std::optional<double> SetpointResponses::error_integral(double b) const {
    if (!zero_.error_integral_final || !IE_of_one_) return std::nullopt;
    return *zero_.error_integral_final + b * (*IE_of_one_ - *zero_.error_integral_final);
}

std::vector<ResponseNode> SetpointResponses::weighted(double b) const {
    std::vector<ResponseNode> nodes = zero_.nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes[i].y += b * added_[i].y;
        nodes[i].y_slope += b * added_[i].y_slope;
        nodes[i].error_integral += b * added_[i].error_integral;
    }
    return nodes;
}

SetpointResponses::Filtered::Filtered(std::vector<ResponseNode> nodes, std::optional<double> error_integral,
                                      double limit)
    : nodes_(std::move(nodes)), error_integral_(error_integral), limit_(limit) {
    const double level = 1 + limit / 100;
    pieces_.reserve(nodes_.size());
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
        const ResponseNode &a = nodes_[i - 1], &b = nodes_[i];
        const double h = b.t - a.t;
        if (std::max(a.y, b.y) > level || std::max(a.y + h * a.y_slope / 3, b.y - h * b.y_slope / 3) > level)
            exceeding_ = i + 1;
        if (jumps_after(nodes_, i - 1)) {
            pieces_.push_back({});
            continue;
        }
        const double slope = (b.y - a.y) / h;
        pieces_.push_back({h, a.y, a.y_slope, (3 * slope - 2 * a.y_slope - b.y_slope) / h,
                           (a.y_slope + b.y_slope - 2 * slope) / (h * h)});
    }
}

double SetpointResponses::Filtered::excess(double T) const {
    // The response without filter keeps the limit.
    if (exceeding_ == 0) return -limit_;
    return percent_above(behind(T, exceeding_)) - limit_;
}

double SetpointResponses::Filtered::IAE(double T) const {
    const auto integral = error_integral_ ? std::optional(*error_integral_ + T) : std::nullopt;
    return integral_of_absolute_error(behind(T, nodes_.size()), 1, integral);
}

std::vector<ResponseNode> SetpointResponses::Filtered::behind(double T, std::size_t count) const {
    std::vector<ResponseNode> nodes(nodes_.begin(), nodes_.begin() + static_cast<std::ptrdiff_t>(count));
    double z = 0, decay_h = 0, decay = 1;
    nodes.front().y = nodes.front().y_slope = 0;
    for (std::size_t i = 1; i < count; ++i) {
        const Piece& piece = pieces_[i - 1];
        if (const double h = piece.h; h > 0) {
            // Successive steps are equal but for the rounding of their times.
            if (std::abs(h - decay_h) > kSameInstant * nodes_[i].t) {
                decay_h = h;
                decay = std::exp(-h / T);
            }
            const auto particular = [&](double s) {
                const double p = piece.y + s * (piece.slope + s * (piece.curve + s * piece.twist)),
                             p1 = piece.slope + s * (2 * piece.curve + s * 3 * piece.twist),
                             p2 = 2 * piece.curve + s * 6 * piece.twist;
                return p - T * (p1 - T * (p2 - T * 6 * piece.twist));
            };
            z = particular(h) + (z - particular(0)) * decay;
        }
        nodes[i].y = z;
        nodes[i].y_slope = (nodes_[i].y - z) / T;
        nodes[i].error_integral = nodes_[i].error_integral + T * z;
    }
    return nodes;
}

}  // namespace tunewright
