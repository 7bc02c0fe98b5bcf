// A step that is longer than the dead time.
#pragma once

#include <array>
#include <vector>

#include "engine/simulation/propagator.h"
#include "engine/simulation/response_system.h"

namespace tunewright {

/// Its last part sees the step's own, still unknown output. Linear in value and slope at the end.
class LongStep {
public:
    /// Of length h0 2^level; the dead time is h0 2^level_of_L. `system` must live as long as this.
    LongStep(const ResponseSystem& system, Propagator& propagator, int level, int level_of_L);

    double h() const { return h_; }

    /// What a step starts from, before its output is known.
    struct Start {
        Signal v_end, w_end;  ///< at the end, as far as they follow from what is known now
        std::vector<double> x;
    };
    void start(Signal v0, Signal w0, const std::vector<double>& x, std::vector<double>& scratch, Start& start) const;

    /// Puts the states at the step's end into x; gives the delayed signal there. `added` is what the controller's
    /// output gets on top at the end, not from x.
    Signal finish(const Start& start, Signal added, std::vector<double>& x) const;

private:
    struct Effect {
        std::vector<double> x;
        Signal v, out;
    };

    std::array<double, 4> taylor(const std::array<double, 4>& ends) const {
        return hermite_taylor(h_, ends[0], ends[1], ends[2], ends[3]);
    }
    Signal at_end(const std::array<double, 4>& ends) const;
    Signal output(const std::vector<double>& x, Signal v, bool with_inputs) const;
    Effect effect(const std::array<double, 4>& ends) const;

    const ResponseSystem& system_;
    Propagator& propagator_;
    ExactStep over_L_, rest_;
    double h_ = 0;
    Effect end_value_, end_slope_;
};

}  // namespace tunewright
