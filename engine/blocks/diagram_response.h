// The response of a block diagram to steps that enter at its signals at t = 0, every dead time exact.
//
// Method of steps (Bellman and Cooke 1963, chapter 3): within a step each delayed signal is a cubic through stored
// values and slopes, everything else is exact. Steps end at the echoes of every jump, are short behind them, and double
// where a cubic through the outer points of two steps is accurate enough in the middle. What enters and leaves
// within a step, because that is longer than a dead time, is solved for.
#pragma once

#include <optional>
#include <vector>

#include "engine/blocks/diagram_system.h"
#include "engine/numerics/cubic.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

struct DiagramStep {
    int signal = 0;
    double size = 1;
};

struct DiagramResponseOptions {
    double tolerance = 1e-7;             ///< of the interpolation, relative to each signal's largest value
    double settled = 1e-6;               ///< ends when every signal stays within this fraction of its largest value
    std::optional<double> horizon = {};  ///< ends here instead
    int max_steps = 60000;
};

class DiagramResponse {
public:
    /// The loops must be stable unless there is a horizon. Error: that of make_system().
    static Expected<DiagramResponse> of(const BlockDiagram& diagram, const std::vector<DiagramStep>& steps,
                                        const DiagramResponseOptions& options);

    bool settles() const { return settles_; }
    /// The nodes of two signals, without what enters at u from outside; `r`: what y should become. The error's final
    /// integral is known if y becomes r, as with integral action.
    StepResponse pair(int y, int u, double r) const;
    /// Of the last node.
    double end() const { return t_.back(); }
    /// One signal at ascending times >= 0, without what enters at it from outside; after the last node its final value.
    std::vector<double> sampled(int signal, const std::vector<double>& t) const;

private:
    friend class DiagramRun;
    Signal at(std::size_t node, int signal) const {
        const double* values = values_.data() + node * 2 * static_cast<std::size_t>(signals_);
        return {values[signal], values[signals_ + signal]};
    }

    int signals_ = 0;
    std::vector<double> t_;       ///< of each node; two nodes of equal t have the values before and after a jump
    std::vector<double> values_;  ///< of each node the values of all signals, then their slopes
    std::vector<double> inputs_;  ///< what enters at each signal
    std::vector<double> final_;   ///< where each signal comes to rest; empty: with a horizon
    std::vector<double> slope_;  ///< of each signal's transform times s, at s = 0: less the integral of its way to rest
    bool settles_ = true;
};

}  // namespace tunewright
