#include "engine/blocks/within_step.h"

#include <cmath>

namespace tunewright {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kLeastCondition = 1e-9;  // reciprocal

}  // namespace

WithinStep::WithinStep(const DiagramSystem& system, double h, const std::function<VectorXd(const VectorXd&)>& after,
                       const Eigen::MatrixXd& to_node, double slack)
    : h_(h) {
    for (std::size_t k = 0; k < system.delayed.size(); ++k) {
        if (system.delayed[k].L >= h_ - slack) continue;
        signals_.push_back(k);
        until_.push_back(h_ - system.delayed[k].L);
    }
    if (empty()) return;
    const Index count = Index(signals_.size()), inputs = Index(system.delayed.size()), all = system.signals(),
                states = system.states();
    const VectorXd none = VectorXd::Zero(inputs);
    Eigen::MatrixXd back = Eigen::MatrixXd::Identity(2 * count, 2 * count);
    VectorXd input(states + 4 * inputs), at_node(states + 2 * inputs);
    for (Index column = 0; column < 2 * count; ++column) {
        const Index signal = Index(signals_[std::size_t(column % count)]);
        VectorXd end = none, end_slope = none;
        (column < count ? end : end_slope)[signal] = 1;
        const Cubic c = parabola(h_, 0, {end[signal], end_slope[signal]});
        input.setZero();
        for (std::size_t j = 0; j < c.size(); ++j) input[states + Index(j) * inputs + signal] = c[j];
        at_node << after(input), end, end_slope;
        const VectorXd node = to_node * at_node;
        for (Index row = 0; row < count; ++row) {
            const Index from = system.delayed[signals_[std::size_t(row)]].from;
            const Signal part = left(std::size_t(row), 0, {node[from], node[all + from]});
            back(row, column) -= part.value;
            back(count + row, column) -= part.slope;
        }
    }
    of_left_.compute(back);
    const double condition = of_left_.rcond();
    solvable_ = std::isfinite(condition) && condition > kLeastCondition;
}

Signal WithinStep::left(std::size_t which, double now, Signal end) const {
    const Cubic c = parabola(h_, now, end);
    Signal out;
    evaluate(c, until_[which], out.value, out.slope);
    return out;
}

}  // namespace tunewright
