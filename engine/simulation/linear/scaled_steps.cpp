#include "engine/simulation/linear/scaled_steps.h"

#include <algorithm>
#include <cmath>

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr int kRepetitions = 20;      // iterations for a step that depends on its own end through the scaled integral
constexpr double kConverged = 1e-10;  // of the response's size

}  // namespace

ScaledSteps::ScaledSteps(const RunSetup& setup, const ErrorScaling& scaling, double beyond,
                         std::vector<ResponseNode>& nodes)
    : system_(setup.system),
      scaling_(scaling),
      nodes_(nodes),
      level_of_L_(setup.level_of_L),
      integral_(Index(system_.s.integral_state)),
      into_u_(system_.s.M[integral_]),
      into_y_(system_.s.Y[integral_]),
      beyond_(beyond),
      delayed_(nodes, system_.in.d, system_.s.L, setup.h0),
      propagator_(system_.n, system_.F, input(), system_.b, setup.h0),
      long_steps_(system_, setup.level_of_L),
      x_(Index(system_.n), 0.0) {}

/// The input of the steps as a cubic: the delayed signal or, without dead time, the addition to the integral's input by
/// scaling.
std::vector<double> ScaledSteps::input() const {
    if (system_.delayed) return system_.G;
    std::vector<double> into_integral(Index(system_.n), 0.0);
    into_integral[integral_] = 1;
    return into_integral;
}

void ScaledSteps::begin() { add(node_at(system_, 0, x_, {})); }

/// Adds the node, with the change of its slopes by scaling.
void ScaledSteps::add(const ResponseNode& node) {
    scale(nodes_.emplace_back(node));
    excesses_.push_back(excess_);
}

void ScaledSteps::scale(ResponseNode& node) {
    const double e = system_.in.r - node.y;
    excess_.value = scaling_.excess(e);
    node.y_slope += into_y_ * excess_.value;
    node.u_slope += into_u_ * excess_.value;
    excess_.slope = -scaling_.excess_slope(e) * node.y_slope;
}

bool ScaledSteps::take(int level, double t, double largest_y) {
    if (system_.delayed && level > level_of_L_) return take_long(long_steps_.level(level, propagator_), t, largest_y);
    const ExactStep& step = propagator_.level(level);
    if (!system_.delayed) return take_closed(step, t + step.h, level == 0, largest_y);
    take_short(step, t, t + step.h);
    return true;
}

void ScaledSteps::take_last(double t, double end, double largest_y) {
    if (system_.delayed)
        take_short(*last_, t, end);
    else
        take_closed(*last_, end, true, largest_y);
}

/// In steps up to the dead time, y does not depend on the integral's own input within the step, which is therefore
/// known once y is.
void ScaledSteps::take_short(const ExactStep& step, double t, double end) {
    const Signal v0 = delayed_.from(t), v1 = delayed_.until(end);
    advance(step, hermite_taylor(step.h, v0, v1), x_);
    const Signal before = excess_;
    add(node_at(system_, end, x_, v1));
    const double added = hermite_integral(step.h, before, excess_);
    x_[integral_] += added;
    nodes_.back().u += into_u_ * added;
}

bool ScaledSteps::take_long(const LongStep& step, double t, double largest_y) {
    const double end = t + step.h();
    const ResponseNode& now = nodes_.back();
    step.start(delayed_.from(t), {now.u + system_.in.d, now.u_slope}, x_, start_);
    return settle(step.h(), false, largest_y, [&](double added) {
        const Signal v =
            step.finish(start_, {into_u_ * added, into_u_ * excess_.value, into_u_ * excess_.slope}, end_x_);
        end_x_[integral_] += added;
        return node_at(system_, end, end_x_, v);
    });
}

/// For a loop without dead time.
bool ScaledSteps::take_closed(const ExactStep& step, double end, bool shortest, double largest_y) {
    const Signal before = excess_;
    return settle(step.h, shortest, largest_y, [&](double) {
        end_x_ = x_;
        advance(step, hermite_taylor(step.h, before, excess_), end_x_);
        return node_at(system_, end, end_x_, {});
    });
}

/// Finds the end of a step whose y depends on the integral's own input by iteration: `try_end` computes the end for an
/// assumed excess there. False if it does not converge, which a shorter step cures; the `shortest` step is accepted in
/// any case.
template <class TryEnd>
bool ScaledSteps::settle(double h, bool shortest, double largest_y, const TryEnd& try_end) {
    const Signal before = excess_;
    const double size = std::max(largest_y, std::abs(system_.in.r));
    ResponseNode node;
    bool converged = false;
    excess_.value += h * before.slope;
    for (int i = 0; i < kRepetitions && !converged; ++i) {
        const Signal assumed = excess_;
        node = try_end(hermite_integral(h, before, assumed));
        scale(node);
        const double change =
            std::max(std::abs(excess_.value - assumed.value), h * std::abs(excess_.slope - assumed.slope));
        converged = !(change > kConverged * size);
    }
    if (!converged && !shortest) {
        excess_ = before;
        return false;
    }
    x_.swap(end_x_);
    nodes_.push_back(node);
    excesses_.push_back(excess_);
    return true;
}

void ScaledSteps::add_jump(double t) { add(node_at(system_, t, x_, delayed_.from(t))); }

Misfit ScaledSteps::fit(double floor) const {
    const Index last = excesses_.size() - 1;
    const Signal &a = excesses_[last - 2], &b = excesses_[last - 1], &c = excesses_[last];
    double size = floor;
    for (Index i = last - 2; i <= last; ++i) size = std::max(size, std::abs(nodes_[i].y - system_.in.r));
    return {std::abs(b.value - hermite_midpoint(nodes_[last].t - nodes_[last - 2].t, a, c)), size};
}

std::optional<double> ScaledSteps::final_integral(std::optional<double> exact) const {
    if (!exact) return exact;
    return nodes_.back().error_integral + (*exact - error_integral());
}

}  // namespace tunewright
