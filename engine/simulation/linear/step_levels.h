// The lengths of a linear run's steps: h0 2^level, chosen step by step.
//
// With a dead time L = h0 2^level_of_L a run consists of segments of length L. A jump returns at the start of each,
// smoother every time: a segment starts with a short step, and the steps become longer. After the echoes steps may be
// longer than L.
//
// The functions are in the header because a step is so short that function calls would cost a response 2 %.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tunewright {

/// Fit of a cubic over the last two steps. fine: a step of twice the length is accurate enough; rough: even these were
/// too long; unknown: there are too few equal steps.
enum class Smoothness { unknown, rough, enough, fine };

/// Error of such a cubic at the value between them, and the size that it is relative to.
struct Misfit {
    double error = 0, scale = 0;

    bool within(double tolerance) const { return error <= tolerance * scale; }  // without a division
};

/// The smoothness by the worst of them.
inline Smoothness smoothness_of(const std::array<Misfit, 3>& fits, double tolerance) {
    constexpr double kRoughTolerances = 40;  // multiple of the tolerance: doubling a step costs a factor of 16 at order
                                             // 4, plus a margin
    const auto all_within = [&](double limit) {
        return fits[0].within(limit) && fits[1].within(limit) && fits[2].within(limit);
    };
    if (all_within(tolerance)) return Smoothness::fine;
    return all_within(kRoughTolerances * tolerance) ? Smoothness::enough : Smoothness::rough;
}

class StepLevels {
public:
    struct Setting {
        bool delayed = false;
        double h0 = 0;       ///< > 0
        int level_of_L = 0;  ///< with a dead time: L = h0 2^level_of_L
        int echoes = 0;      ///< segments whose start may have a jump or kink (echoes_that_count)
        double longest = std::numeric_limits<double>::infinity();  ///< step, with a dead time
    };
    explicit StepLevels(const Setting& setting) : set_(setting) {}

    int level() const { return level_; }
    bool longer_than_L() const { return set_.delayed && level_ > set_.level_of_L; }
    /// Number of steps of the present level since it changed or since a segment started.
    int equal_steps() const { return equal_steps_; }
    /// Time since t = 0 in units of h0: exact.
    double ticks() const { return ticks_; }

    void repeat(int level) { level_ = level; }  ///< sets the level of an earlier run
    void lower() { --level_; }                  ///< the step was too long
    void go_no_higher() { max_ = level_; }      ///< longer steps amplify their own errors
    void choose(Smoothness smoothness);         ///< chooses the next step's level

    /// Counts a step of the present level. True: it ended a segment whose successor may start with a jump.
    bool count();
    /// After a jump the node before it does not count as a neighbour.
    void note_jump() { equal_steps_ = 0; }

private:
    static constexpr int kFirstEchoes = 2;          // the kinks at L and 2L always get the shortest step
    static constexpr int kStepsBeforeLongOnes = 4;  // equal steps before the first one that is longer than L

    static double ticks_of(int level) { return static_cast<double>(1ULL << level); }  // faster than ldexp
    bool echoes_are_over() const;
    bool may_double() const;
    void restart();

    Setting set_;
    int segment_ = 0;
    int level_ = 0, max_ = 60, last_level_ = -1, equal_steps_ = 0;
    bool segment_started_ = true, climb_blocked_ = false;
    int restart_level_ = 0, top_level_ = 0;
    long offset_ = 0;  // time since the segment's start, in units of h0
    double ticks_ = 0;
};

inline bool StepLevels::echoes_are_over() const {
    return !set_.delayed || (segment_ >= set_.echoes && restart_level_ >= std::min(level_, set_.level_of_L));
}

inline void StepLevels::choose(Smoothness smoothness) {
    if (segment_started_ && !echoes_are_over()) restart();
    if (smoothness == Smoothness::rough && level_ > 0) {
        if (level_ <= restart_level_) restart_level_ = std::max(0, restart_level_ - 2);
        --level_;
    }
    if (smoothness == Smoothness::fine && may_double()) ++level_;
    if (level_ < top_level_ && (smoothness == Smoothness::rough || smoothness == Smoothness::enough))
        climb_blocked_ = true;
    // Never across the end of a segment while jumps occur there.
    if (!echoes_are_over() || (set_.delayed && level_ <= set_.level_of_L))
        while (level_ > 0 && (offset_ & ((1L << level_) - 1)) != 0) --level_;
}

/// A segment starts with short steps, at the scale of the kink that its start may have. If the steps could grow back to
/// the former length without delay, the kink has faded, and the next segment starts with longer steps.
inline void StepLevels::restart() {
    if (segment_ > kFirstEchoes && !climb_blocked_) restart_level_ += 2;
    climb_blocked_ = false;
    top_level_ = level_;
    level_ = std::min(level_, restart_level_);
}

inline bool StepLevels::may_double() const {
    if (level_ >= max_) return false;
    if (!set_.delayed) return true;
    if (set_.h0 * ticks_of(level_ + 1) > set_.longest) return false;
    return level_ + 1 <= set_.level_of_L || (echoes_are_over() && equal_steps_ >= kStepsBeforeLongOnes);
}

inline bool StepLevels::count() {
    equal_steps_ = level_ == last_level_ && !segment_started_ ? equal_steps_ + 1 : 1;
    last_level_ = level_;
    segment_started_ = false;
    ticks_ += ticks_of(level_);
    if (!set_.delayed || longer_than_L()) return false;
    offset_ += 1L << level_;
    if (offset_ != (1L << set_.level_of_L)) return false;
    offset_ = 0;
    ++segment_;
    segment_started_ = !echoes_are_over();
    return segment_started_;
}

}  // namespace tunewright
