// The lengths of a linear run's steps: h0 2^level, chosen step by step.
//
// With a dead time L = h0 2^level_of_L a run is made of segments of length L. A jump comes back at the start of each,
// smoother every time: a segment starts with a short step and climbs. Once the echoes are over steps may be longer
// than L.
#pragma once

#include <limits>

namespace tunewright {

/// How a cubic over the last two steps fits: fine, a step twice as long would do; rough, even these were too long;
/// unknown, too few equal steps to tell.
enum class Smoothness { unknown, rough, enough, fine };

class StepLevels {
public:
    struct Setting {
        bool delayed = false;
        double h0 = 0;       ///< > 0
        int level_of_L = 0;  ///< with a dead time: L = h0 2^level_of_L
        int echoes = 0;      ///< segments whose start may bring a jump or kink (echoes_that_count)
        double longest = std::numeric_limits<double>::infinity();  ///< step, with a dead time
    };
    explicit StepLevels(const Setting& setting) : set_(setting) {}

    int level() const { return level_; }
    bool longer_than_L() const { return set_.delayed && level_ > set_.level_of_L; }
    /// The steps of the present level since it was last changed, or a segment was started.
    int equal_steps() const { return equal_steps_; }
    /// Units of h0 since t = 0: exact.
    double ticks() const { return ticks_; }

    void repeat(int level) { level_ = level; }  ///< of an earlier run
    void lower() { --level_; }                  ///< the step was too long
    void choose(Smoothness smoothness);         ///< the next step's

    /// A step of the present level has been taken. True: it ended a segment whose successor may start with a jump.
    bool count();
    /// The node before the jump is no neighbour of those after it.
    void note_jump() { equal_steps_ = 0; }

private:
    bool echoes_are_over() const;
    bool may_double() const;
    void restart();

    Setting set_;
    int segment_ = 0;
    int level_ = 0, last_level_ = -1, equal_steps_ = 0;
    bool segment_started_ = true, climb_blocked_ = false;
    int restart_level_ = 0, top_level_ = 0;
    long offset_ = 0;  // from the segment's start, in units of h0
    double ticks_ = 0;
};

}  // namespace tunewright
