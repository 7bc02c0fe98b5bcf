// A plant's rational part with a constant input: exact states, and its output between them as a polynomial.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine/simulation/run/held_motion.h"

namespace tunewright {

/// The quintic through value, slope and curvature at both ends of a step of length h. On steps of a tenth of a radian
/// of the fastest mode its error is 2e-11 of that mode's amplitude.
class Quintic {
public:
    Quintic() = default;
    Quintic(double h, const OutputMotion& start, const OutputMotion& end);

    double at(double tau) const;     ///< 0 <= tau <= h
    double slope(double tau) const;  ///< d/dtau
    double length() const { return h_; }

    /// The time at which the slope changes sign inside the step, if it does; at most one, because steps are short.
    std::optional<double> extremum() const;

private:
    double h_ = 0;
    std::array<double, 6> c_{};
};

/// The motion with the step lengths that a relay needs: as long as the modes that have not decayed allow.
class RelayMotion : public HeldMotion {
public:
    /// `direction` is 1 or -1.
    RelayMotion(const LinearPlant& plant, double direction);

    int integrators() const { return integrators_; }
    /// The step of length shortest() 2^k, 0 <= k < 60, computed once.
    const HeldStep& level(int k);

    double shortest() const { return shortest_; }
    /// The step length for the modes that have not decayed `elapsed` after the last change of v; `quiet`: all have
    /// decayed.
    double spacing(double elapsed, bool& quiet) const;
    /// The time after which every decaying mode is below 1e-10 of its initial value; 0 if there is none.
    double decay_time() const { return decay_time_; }
    /// True if every mode decays: y stays bounded for any switching of the relay.
    bool bounded() const;
    /// The largest real part of a pole, if positive; else 0.
    double growth_rate() const { return growth_rate_; }

private:
    struct Mode {
        double magnitude = 0;
        double ends = 0;  ///< time at which it has decayed; infinite if it does not
    };

    int integrators_;
    double shortest_ = 1, decay_time_ = 0, growth_rate_ = 0;
    std::vector<Mode> modes_;
    std::vector<std::optional<HeldStep>> levels_;
};

}  // namespace tunewright
