// A relay with hysteresis and a plant with dead time, event by event: the input of the plant's rational part is
// piecewise constant, so each piece is exact, and the times of the switches are its roots.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "engine/simulation/relay/relay_motion.h"

namespace tunewright {

/// u_minus < u_plus. The relay's input is y of RelayMotion: to u_minus when y > hysteresis, to u_plus when y <
/// -hysteresis.
struct RelayLevels {
    double u_plus = 1, u_minus = -1;
    double hysteresis = 0;
};

/// A switch of the relay that has not yet reached the plant's rational part.
struct PendingInput {
    double t = 0;
    double v = 0;
};

/// The initial state of a run, at t = 0.
struct RelayState {
    std::vector<double> x;
    double v = 0;  ///< present input of the rational part
    double u = 0;  ///< present output of the relay
    std::deque<PendingInput> pending;
};

/// An interval [t, t + h] in which u and the delayed input are constant; h = 0 if y jumps over the threshold.
struct RelayPiece {
    double t = 0, h = 0;
    double t_end = 0;
    double u = 0;           ///< in this interval
    bool switched = false;  ///< the relay switches at t_end
    Quintic y;
};

enum class RelayEnd {
    running,
    latched,    ///< y comes to rest, or moves away between the thresholds: no further switch
    escaped,    ///< y is unbounded
    too_fast,   ///< switches accumulate
    exhausted,  ///< the allowed number of steps is reached
};

/// The time for which u_plus must be held at the start: 0 except for a plant without dead time and a relay without
/// hysteresis. At rest on its threshold such a relay would switch infinitely fast; half the plant's lags are enough to
/// start it.
double held_start(const LinearPlant& plant, const RelayLevels& levels);

class RelayRun {
public:
    /// Starts at rest, with u = u_plus from t = 0; the relay does not switch before `held`.
    RelayRun(RelayMotion& motion, double dead_time, const RelayLevels& levels, double held = 0);
    RelayRun(RelayMotion& motion, double dead_time, const RelayLevels& levels, RelayState start);

    /// The next interval; empty once `end()` is not `running`.
    std::optional<RelayPiece> next();

    RelayEnd end() const { return end_; }
    double t() const { return t_; }
    double u() const { return u_; }
    double y() const { return motion_->output(x_, v_).y; }
    std::int64_t steps() const { return steps_; }
    /// The state when u_plus last reached the rational part.
    const std::vector<double>& state_at_rise() const { return x_rise_; }

private:
    void take_pending();
    double excess(double y) const;  ///< > 0: beyond the threshold at which the relay switches
    bool settle_or_escape(bool quiet, double elapsed, double slope);
    std::optional<double> crossing(const Quintic& y, double first) const;
    double polish(double tau, double low, double high) const;
    RelayPiece switch_over(RelayPiece piece);

    RelayMotion* motion_;
    double L_;
    RelayLevels levels_;
    double t_ = 0, changed_at_ = 0, switched_at_ = 0;
    std::vector<double> x_, x_rise_;
    double v_ = 0, u_ = 0;
    std::deque<PendingInput> pending_;
    double held_ = 0;
    int switches_ = 0, crowded_ = 0;
    std::int64_t steps_ = 0;
    double swing_ = 0;  ///< largest abs y before the fourth switch
    RelayEnd end_ = RelayEnd::running;
};

}  // namespace tunewright
