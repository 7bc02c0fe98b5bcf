// The motion of a linear plant while its input is held: exact steps of any fixed length, and any number of halvings of
// it.
#pragma once

#include <vector>

#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {

/// Plant states and the integral of y. The caller handles the dead time: v is the delayed input.
struct HeldState {
    std::vector<double> x;
    double y_integral = 0;
};

/// Motion over the length h with constant v: x(h) = e^(A h) x + psi(h) B v, and the integral of y = C x + D v.
class HeldMotion {
public:
    HeldMotion(const LinearPlant& plant, double h);

    double length() const { return levels_.front().h; }
    /// Moves the state by h 2^-level.
    void advance(HeldState& state, double v, int level = 0);

private:
    struct Step {
        double h = 0;
        std::vector<double> Phi, Gamma;  // for the states and the integral of y together, (n + 1) x (n + 1) and n + 1
    };
    Step step(double h) const;

    const LinearPlant* plant_;
    std::vector<Step> levels_;
    std::vector<double> before_, after_;
};

/// y and its slope while v is held.
struct HeldOutput {
    double y = 0, slope = 0;
};

class HeldReader {
public:
    explicit HeldReader(const LinearPlant& plant);
    HeldOutput at(const std::vector<double>& x, double v) const;

private:
    std::vector<double> C_, CA_;
    double CB_ = 0, D_ = 0;
};

}  // namespace tunewright
