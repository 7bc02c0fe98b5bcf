// A block diagram broken at one signal, all other loops closed, over frequency.
//
//   const DiagramLoop valve(diagram, u);                          // a FrequencyLoop
//   const Peaks peaks = find_peaks(valve, make_peak_grid(valve)); // its Ms and Mt
#pragma once

#include "engine/blocks/block_diagram.h"
#include "engine/blocks/diagram_stability.h"
#include "engine/loop/frequency_loop.h"

namespace tunewright {

class DiagramLoop {
public:
    /// The diagram must outlive this.
    DiagramLoop(const BlockDiagram& diagram, int signal) : diagram_(&diagram), signal_(signal) {}

    /// C S is left out: what disturbs u is another signal.
    LoopPoint at(double omega) const;
    LoopGrid ends() const;
    double turning_time() const { return diagram_->total_dead_time(); }

    const BlockDiagram& diagram() const { return *diagram_; }

private:
    LoopPoint point(std::complex<double> s) const;

    const BlockDiagram* diagram_;
    int signal_;
};

LoopGrid make_loop_grid(const DiagramLoop& loop);

inline StabilityCount count_unstable_poles(const DiagramLoop& loop) { return count_unstable_poles(loop.diagram()); }

}  // namespace tunewright
