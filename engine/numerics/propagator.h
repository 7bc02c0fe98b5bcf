// Exact steps of x' = F x + G v + b for an input v that is a cubic polynomial within the step.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/numerics/cubic.h"

namespace tunewright {

/// One step of length h: x(h) = Phi x(0) + sum_j Gamma[j] v_j + constant with v(s) = sum_j v_j s^j/j!.
struct ExactStep {
    double h = 0;
    std::vector<double> Phi;                   // n x n, row by row
    std::array<std::vector<double>, 4> Gamma;  // integral of e^(F (h - s)) G s^j/j!
    std::vector<double> constant;              // integral of e^(F s) b
};

/// x := Phi x + Gamma v + constant. `scratch` has as many entries as x.
void advance(const ExactStep& step, const Cubic& v, std::vector<double>& x, std::vector<double>& scratch);

class Propagator {
public:
    Propagator(int n, std::vector<double> F, std::vector<double> G, std::vector<double> b, double h0);

    /// The step of length h0 2^level, computed once by doubling.
    const ExactStep& level(int level);
    /// The step of any length h > 0.
    ExactStep step(double h) const;
    /// A step of length first.h + second.h.
    ExactStep compose(const ExactStep& first, const ExactStep& second) const;

    int states() const { return n_; }
    double h0() const { return h0_; }

private:
    int n_;
    std::vector<double> F_, G_, b_;
    double h0_, norm_;
    std::vector<ExactStep> levels_;
};

}  // namespace tunewright
