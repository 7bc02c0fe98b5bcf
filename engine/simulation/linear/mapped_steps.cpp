#include "engine/simulation/linear/mapped_steps.h"

#include <algorithm>

namespace tunewright {

using Index = std::size_t;

StepMaps::StepMaps(const RunSetup& setup, const std::shared_ptr<Propagator>& known)
    : system_(&setup.system),
      level_of_L_(setup.level_of_L),
      propagator_(known),
      long_steps_(setup.system, setup.level_of_L) {
    const ResponseSystem& s = setup.system;
    if (known == nullptr || !known->is_of(s.F, s.G, s.b, setup.h0))
        propagator_ = std::make_shared<Propagator>(s.n, s.F, s.G, s.b, setup.h0);
}

const StepMap& StepMaps::level(int level) {
    if (system_->delayed && level > level_of_L_) return long_map(level);
    while (static_cast<int>(maps_.size()) <= level)
        maps_.emplace_back(*system_, propagator_->level(static_cast<int>(maps_.size())));
    return maps_[Index(level)];
}

const StepMap& StepMaps::long_map(int level) {
    while (static_cast<int>(long_maps_.size()) < level - level_of_L_)
        long_maps_.push_back(long_step(level_of_L_ + 1 + static_cast<int>(long_maps_.size())).map());
    return long_maps_[Index(level - level_of_L_ - 1)];
}

MappedSteps::MappedSteps(const RunSetup& setup, const std::shared_ptr<Propagator>& known,
                         std::vector<ResponseNode>& nodes)
    : setup_(setup),
      system_(setup.system),
      nodes_(nodes),
      delayed_(nodes, system_.in.d, system_.s.L, setup.h0),
      maps_(setup, known),
      state_(system_) {}

void MappedSteps::begin() { nodes_.emplace_back() = node_at(system_, 0, state_.states(), {}); }

bool MappedSteps::take(int level, double t, double) {
    const bool longer = system_.delayed && level > setup_.level_of_L;
    if (longer && level > setup_.last_mapped) {
        take_unmapped(maps_.long_step(level), t);
    } else {
        const StepMap& map = maps_.level(level);
        take_mapped(map, t, t + map.h(), longer);
    }
    return true;
}

void MappedSteps::take_last(double t, double end, double) { take_mapped(*last_, t, end, false); }

/// `longer`: the step is longer than the dead time.
void MappedSteps::take_mapped(const StepMap& map, double t, double end, bool longer) {
    if (system_.delayed) {
        const Signal v0 = delayed_.from(t);
        const ResponseNode& now = nodes_.back();
        const Signal second = longer ? Signal{now.u + system_.in.d, now.u_slope} : delayed_.until(end);
        map.take(state_, std::array{1.0, v0.value, v0.slope, second.value, second.slope});
    } else {
        map.take(state_, std::array{1.0});
    }
    nodes_.emplace_back() = state_.node(end);
}

void MappedSteps::take_unmapped(const LongStep& step, double t) {
    const ResponseNode& now = nodes_.back();
    x_.assign(state_.states().begin(), state_.states().end());
    step.start(delayed_.from(t), {now.u + system_.in.d, now.u_slope}, x_, start_);
    const Signal v = step.finish(start_, {}, x_);
    std::ranges::copy(x_, state_.states().begin());
    nodes_.emplace_back() = node_at(system_, t + step.h(), x_, v);
}

void MappedSteps::add_jump(double t) { nodes_.emplace_back() = node_at(system_, t, state_.states(), delayed_.from(t)); }

}  // namespace tunewright
