// The motion of a linear plant while its input is held: matrix exponentials, no discretisation error.
#pragma once

#include <vector>

#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// An output with its first two derivatives in time.
struct OutputMotion {
    double y = 0, slope = 0, curvature = 0;
};

/// x(h) = Phi x + Gamma v for v constant over the step.
struct HeldStep {
    double h = 0;
    std::vector<double> Phi;    ///< n x n, row by row
    std::vector<double> Gamma;  ///< n
};

/// x' = A x + B v, y = direction (C x + D v). The dead time is the caller's: v is what arrives.
class HeldMotion {
public:
    /// `direction` is 1 or -1. The integral of y is a last state if it is requested.
    HeldMotion(const LinearPlant& plant, double direction, bool with_integral)
        : HeldMotion(plant.realisation(), direction, with_integral) {}
    HeldMotion(const Realisation& plant, double direction, bool with_integral);

    int states() const { return n_; }
    double direct_term() const { return D_; }
    HeldStep step(double h) const;
    void advance(const HeldStep& step, double v, std::vector<double>& x) const;
    double value(const std::vector<double>& x, double v) const;  ///< y alone
    OutputMotion output(const std::vector<double>& x, double v) const;
    std::vector<double> rate(const std::vector<double>& x, double v) const;  ///< A x + B v
    const std::vector<double>& C() const { return C_; }

private:
    int n_;
    std::vector<double> A_, B_, C_, CA_, CAA_;
    double D_, CB_ = 0, CAB_ = 0;
};

}  // namespace tunewright
