#include "engine/simulation/linear/mapped_steps.h"

#include <algorithm>

namespace tunewright {
namespace {

using Index = std::size_t;

// Of the dead time, a step that is taken by its map: what an integrator's columns owe to rounding grows with the square
// of the length, and longer ones are few.
constexpr int kMostDoublings = 10;

}  // namespace

StepMaps::StepMaps(const ResponseSystem& system, double h0, int level_of_L)
    : system_(&system), level_of_L_(level_of_L), propagator_(system.n, system.F, system.G, system.b, h0) {}

const StepMap& StepMaps::level(int level) {
    while (static_cast<int>(maps_.size()) <= level)
        maps_.emplace_back(*system_, propagator_.level(static_cast<int>(maps_.size())));
    return maps_[Index(level)];
}

const LongStep& StepMaps::long_step(int level) {
    if (long_steps_.empty()) {
        const ExactStep& over_L = propagator_.level(level_of_L_);
        long_steps_.emplace_back(*system_, over_L, over_L);
    }
    while (static_cast<int>(long_steps_.size()) < level - level_of_L_)
        long_steps_.emplace_back(propagator_, long_steps_.back());
    return long_steps_[Index(level - level_of_L_ - 1)];
}

const StepMap& StepMaps::long_map(int level) {
    while (static_cast<int>(long_maps_.size()) < level - level_of_L_)
        long_maps_.push_back(long_step(level_of_L_ + 1 + static_cast<int>(long_maps_.size())).map());
    return long_maps_[Index(level - level_of_L_ - 1)];
}

MappedSteps::MappedSteps(const ResponseSystem& system, double h0, int level_of_L, std::vector<ResponseNode>& nodes)
    : system_(system),
      nodes_(nodes),
      level_of_L_(level_of_L),
      delayed_(nodes, system.in.d, system.s.L, h0),
      maps_(system, h0, level_of_L),
      state_(system) {}

void MappedSteps::begin() { nodes_.emplace_back() = node_at(system_, 0, state_.states(), {}); }

bool MappedSteps::take(int level, double t, double) {
    if (system_.delayed && level > level_of_L_) {
        take_long(level, t);
    } else {
        const StepMap& map = maps_.level(level);
        take_short(map, t, t + map.h());
    }
    return true;
}

void MappedSteps::take_last(double t, double end, double) { take_short(*last_, t, end); }

void MappedSteps::take_short(const StepMap& map, double t, double end) {
    if (system_.delayed) {
        const Signal v0 = delayed_.from(t), v1 = delayed_.until(end);
        map.take(state_, std::array{1.0, v0.value, v0.slope, v1.value, v1.slope});
    } else {
        map.take(state_, std::array{1.0});
    }
    nodes_.emplace_back() = state_.node(end);
}

void MappedSteps::take_long(int level, double t) {
    const ResponseNode& now = nodes_.back();
    const Signal v0 = delayed_.from(t), w0 = {now.u + system_.in.d, now.u_slope};
    if (level - level_of_L_ <= kMostDoublings) {
        const StepMap& map = maps_.long_map(level);
        map.take(state_, std::array{1.0, v0.value, v0.slope, w0.value, w0.slope});
        nodes_.emplace_back() = state_.node(t + map.h());
        return;
    }
    const LongStep& step = maps_.long_step(level);
    x_.assign(state_.states().begin(), state_.states().end());
    step.start(v0, w0, x_, start_);
    const Signal v = step.finish(start_, {}, x_);
    std::ranges::copy(x_, state_.states().begin());
    nodes_.emplace_back() = node_at(system_, t + step.h(), x_, v);
}

void MappedSteps::add_jump(double t) { nodes_.emplace_back() = node_at(system_, t, state_.states(), delayed_.from(t)); }

}  // namespace tunewright
