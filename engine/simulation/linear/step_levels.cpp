#include "engine/simulation/linear/step_levels.h"

#include <algorithm>
#include <cmath>

namespace tunewright {
namespace {

constexpr int kFirstEchoes = 2;  // the kinks at L and 2L are always met with the shortest step
constexpr int kMaxLevel = 60;
constexpr int kStepsBeforeLongOnes = 4;  // equal steps before the first one that is longer than L

}  // namespace

bool StepLevels::echoes_are_over() const {
    return !set_.delayed || (segment_ >= set_.echoes && restart_level_ >= std::min(level_, set_.level_of_L));
}

void StepLevels::choose(Smoothness smoothness) {
    if (segment_started_ && !echoes_are_over()) restart();
    if (smoothness == Smoothness::rough && level_ > 0) {
        if (level_ <= restart_level_) restart_level_ = std::max(0, restart_level_ - 2);
        --level_;
    }
    if (smoothness == Smoothness::fine && may_double()) ++level_;
    if (level_ < top_level_ && (smoothness == Smoothness::rough || smoothness == Smoothness::enough))
        climb_blocked_ = true;
    // Never across the end of a segment while jumps come with it.
    if (!echoes_are_over() || (set_.delayed && level_ <= set_.level_of_L))
        while (level_ > 0 && (offset_ & ((1L << level_) - 1)) != 0) --level_;
}

/// A segment starts short, at the scale of the kink that its start may bring. Where the way up to the former length was
/// free, the kink has faded: the next one starts longer.
void StepLevels::restart() {
    if (segment_ > kFirstEchoes && !climb_blocked_) restart_level_ += 2;
    climb_blocked_ = false;
    top_level_ = level_;
    level_ = std::min(level_, restart_level_);
}

bool StepLevels::may_double() const {
    if (level_ >= kMaxLevel) return false;
    if (!set_.delayed) return true;
    if (std::ldexp(set_.h0, level_ + 1) > set_.longest) return false;
    return level_ + 1 <= set_.level_of_L || (echoes_are_over() && equal_steps_ >= kStepsBeforeLongOnes);
}

bool StepLevels::count() {
    equal_steps_ = level_ == last_level_ && !segment_started_ ? equal_steps_ + 1 : 1;
    last_level_ = level_;
    segment_started_ = false;
    ticks_ += std::ldexp(1.0, level_);
    if (!set_.delayed || longer_than_L()) return false;
    offset_ += 1L << level_;
    if (offset_ != (1L << set_.level_of_L)) return false;
    offset_ = 0;
    ++segment_;
    segment_started_ = !echoes_are_over();
    return segment_started_;
}

}  // namespace tunewright
