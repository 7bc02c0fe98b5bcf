// A PI loop through a valve that sticks, in deviations from its operating point, with the row of the record as unit of
// time.
#pragma once

#include <vector>

#include "engine/check/valve/valve_model.h"

namespace tunewright::check {

/// `Ti` in rows, infinite without integral action; the integral rests while abs e <= gap.
struct PiLaw {
    double Kp = 0, Ti = 0, gap = 0;
};

/// y(i) = a y(i - 1) + (1 - a) K (position(i - delay) + load), a = exp(-1/lag); lag in rows, delay at least 1.
struct RowPlant {
    double K = 0, lag = 0;
    int delay = 1;
};

class ValveLoop {
public:
    ValveLoop(const ValveModel& valve, const RowPlant& plant, const PiLaw& law);

    /// Other settings without a bump of u.
    void take(const PiLaw& law);
    /// The next row, with a load at the plant's input.
    void advance(double load = 0);
    double y() const { return y_; }
    double u() const { return u_; }

private:
    Valve valve_;
    double K_, a_;
    std::vector<double> held_;  ///< a ring of positions and loads on their way
    std::size_t at_ = 0;
    PiLaw law_;
    double y_ = 0, u_ = 0, integral_ = 0;
};

}  // namespace tunewright::check
