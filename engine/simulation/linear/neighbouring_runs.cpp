#include "engine/simulation/linear/neighbouring_runs.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <new>
#include <vector>

#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/mapped_steps.h"

namespace tunewright {
namespace {

using Index = std::size_t;
using Lanes = double __attribute__((vector_size(8 * kMaxNeighbours)));

// Wide registers need memory that is aligned to their size; compilers for common registers do not align to it.
constexpr std::size_t kAlignment = sizeof(Lanes);

template <class T>
struct Aligned {
    using value_type = T;
    T* allocate(Index n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(kAlignment))); }
    void deallocate(T* at, Index) { ::operator delete(at, std::align_val_t(kAlignment)); }
    bool operator==(const Aligned&) const { return true; }
};
using LaneVector = std::vector<Lanes, Aligned<Lanes>>;

/// The numbers one by one, kMaxNeighbours for each of the vector's entries.
double* numbers(LaneVector& lanes) { return static_cast<double*>(static_cast<void*>(lanes.data())); }

/// The maps of each controller.
struct Loops {
    std::vector<RunSetup> setups;
    std::deque<StepMaps> maps;

    Loops(const LinearPlant& plant, std::span<const ParallelPid> controllers, const StepInputs& in,
          const StepSchedule& schedule) {
        setups.reserve(controllers.size());
        for (const auto& controller : controllers) setups.push_back(set_up_run(plant, controller, in, &schedule));
        // With a dead time the gains do not appear in the states' own equations.
        auto known = schedule.propagator;
        for (const auto& setup : setups) known = maps.emplace_back(setup, known).propagator();
    }
};

/// The maps of one level, side by side.
struct LaneMap {
    LaneVector columns;
    bool longer = false;  // true: longer than the dead time
};

/// y, y', u, u' and the error's integral at a node.
struct alignas(kAlignment) LaneNode {
    Lanes y = {}, y_slope = {}, u = {}, u_slope = {}, error_integral = {};
};

struct alignas(kAlignment) LaneSignal {
    Lanes value = {}, slope = {};
};

class LaneRun {
public:
    LaneRun(Loops& loops, const StepInputs& in, const StepResponse& run)
        : loops_(loops),
          count_(loops.setups.size()),
          n_(Index(loops.setups[0].system.n)),
          in_(in),
          nodes_(run.nodes),
          levels_(run.schedule.level),
          history_(run.nodes, in.d),
          L_(loops.setups[0].system.s.L),
          slack_(kSameInstant * run.schedule.h0),
          delayed_(loops.setups[0].system.delayed),
          z_(n_ + 4),
          end_(n_ + 4) {
        maps_.resize(1 + Index(*std::ranges::max_element(levels_)));
        for (const auto level : levels_)
            if (maps_[Index(level)].columns.empty()) maps_[Index(level)] = side_by_side(level);
        lanes_.resize(nodes_.size());
        keep_outputs(0, LaneSignal());
    }

    /// Runs through all nodes.
    TUNEWRIGHT_INLINED void go();

    std::array<double, kMaxNeighbours> iaes() const;

private:
    LaneMap side_by_side(int level) {
        LaneMap lanes{.columns = LaneVector((n_ + kStepInputs) * (n_ + 4)),
                      .longer = delayed_ && level > loops_.setups[0].level_of_L};
        for (Index lane = 0; lane < count_; ++lane) {
            const StepMap& map = loops_.maps[lane].level(level);
            double* to = numbers(lanes.columns) + lane;
            for (Index k = 0; k < n_ + kStepInputs; ++k)
                for (Index i = 0; i < n_ + 4; ++i, to += kMaxNeighbours) *to = map.column(k)[i];
        }
        return lanes;
    }

    /// Adds a node computed from the states alone: the first one, and after a jump.
    void keep_outputs(Index node, const LaneSignal& v) {
        std::vector<double> x(n_);
        for (Index k = 0; k < count_; ++k) {
            for (Index i = 0; i < n_; ++i) x[i] = z_[i][k];
            const ResponseNode at = node_at(loops_.setups[k].system, 0, x, {v.value[k], v.slope[k]});
            LaneNode& to = lanes_[node];
            to.y[k] = at.y, to.y_slope[k] = at.y_slope, to.u[k] = at.u, to.u_slope[k] = at.u_slope;
            to.error_integral[k] = at.error_integral;
        }
    }

    TUNEWRIGHT_INLINED void at_node(Index k, LaneSignal& to) const {
        to.value = lanes_[k].u + in_.d;
        to.slope = lanes_[k].u_slope;
    }

    /// The delayed signal just before and just after t.
    TUNEWRIGHT_INLINED void look_up(double t, LaneSignal& before, LaneSignal& after) {
        const auto place = history_.find(t, slack_);
        if (!place.between) {
            before = after = LaneSignal();
            if (!place.rest_before) at_node(place.first, before);
            if (!place.rest_after) at_node(place.last, after);
            return;
        }
        const LaneNode &a = lanes_[place.first], &b = lanes_[place.last];
        const double h = nodes_[place.last].t - nodes_[place.first].t, s = t - nodes_[place.first].t;
        const CubicOf<Lanes> u = hermite_taylor(h, a.u, a.u_slope, b.u, b.u_slope);
        evaluate(u, s, before.value, before.slope);
        before.value += in_.d;
        after = before;
    }

    /// `kAtOnce` rows at a time stay in registers, with their sums side by side; the last rows may be computed twice.
    template <Index kAtOnce>
    TUNEWRIGHT_INLINED void take_rows(const LaneMap& map, const std::array<Lanes, kStepInputs>& inputs) {
        const Index rows = n_ + 4, used = delayed_ ? kStepInputs : 1;
        for (Index i = 0; i < rows; i += kAtOnce) {
            const Index row = std::min(i, rows - kAtOnce);
            std::array<Lanes, kAtOnce> sum{};
            const Lanes* column = map.columns.data() + row;
            const auto add = [&](const Lanes& weight) {
                for_each_index<kAtOnce>([&](auto k) { sum[k] += column[k] * weight; });
                column += rows;
            };
            for (Index k = 0; k < n_; ++k) add(z_[k]);
            for (Index k = 0; k < used; ++k) add(inputs[k]);
            for_each_index<kAtOnce>([&](auto k) { end_[row + k] = sum[k]; });
        }
        z_.swap(end_);
    }

    TUNEWRIGHT_INLINED void take(const LaneMap& map, const std::array<Lanes, kStepInputs>& inputs) {
        constexpr Index kMost = 8;
        const Index rows = n_ + 4, parts = (rows + kMost - 1) / kMost;
        switch ((rows + parts - 1) / parts) {
            case 8: return take_rows<8>(map, inputs);
            case 7: return take_rows<7>(map, inputs);
            case 6: return take_rows<6>(map, inputs);
            default: return take_rows<5>(map, inputs);
        }
    }

    Loops& loops_;
    Index count_, n_;
    StepInputs in_;
    const std::vector<ResponseNode>& nodes_;
    const std::vector<signed char>& levels_;
    InputHistory history_;
    double L_, slack_;
    bool delayed_;
    LaneVector z_, end_;
    std::vector<LaneMap> maps_;
    std::vector<LaneNode> lanes_;
};

void LaneRun::go() {
    Index at = 0;
    LaneSignal v0, v1, after;
    bool looked_up = false;
    alignas(kAlignment) std::array<Lanes, kStepInputs> inputs{};
    inputs[0] += 1.0;
    for (const auto level : levels_) {
        const LaneMap& map = maps_[Index(level)];
        if (delayed_) {
            if (looked_up)
                v0 = after;
            else
                look_up(nodes_[at].t - L_, v1, v0);
            looked_up = !map.longer;
            if (map.longer)
                at_node(at, v1);
            else
                look_up(nodes_[at + 1].t - L_, v1, after);
            inputs[1] = v0.value, inputs[2] = v0.slope, inputs[3] = v1.value, inputs[4] = v1.slope;
        }
        take(map, inputs);
        LaneNode& to = lanes_[++at];
        to.y = z_[n_], to.y_slope = z_[n_ + 1], to.u = z_[n_ + 2], to.u_slope = z_[n_ + 3];
        to.error_integral = -z_[n_ - 1];
        // A second node at the same time follows a jump.
        if (at + 1 < nodes_.size() && nodes_[at + 1].t <= nodes_[at].t + slack_) keep_outputs(++at, after);
    }
}

/// Like `integral_of_absolute_error`, between the changes of sign of the run's error.
std::array<double, kMaxNeighbours> LaneRun::iaes() const {
    std::array<double, kMaxNeighbours> sum{}, last{};
    const auto node = [&](Index i, Index k) -> ResponseNode {
        const LaneNode& lanes = lanes_[i];
        return {
            .t = nodes_[i].t, .y = lanes.y[k], .y_slope = lanes.y_slope[k], .error_integral = lanes.error_integral[k]};
    };
    for (const auto& change : changes_of_sign(nodes_, in_.r))
        for (Index k = 0; k < count_; ++k) {
            const ResponseNode a = node(change.node - 1, k), b = node(change.node, k);
            const double here = error_integral_at(a, b, in_.r, change_near(a, b, in_.r, change.part));
            sum[k] += std::abs(here - last[k]);
            last[k] = here;
        }
    for (Index k = 0; k < count_; ++k) sum[k] += std::abs(*loops_.setups[k].steady.error_integral - last[k]);
    return sum;
}

TUNEWRIGHT_FOR_AVX2 void go_avx2(LaneRun& run) { run.go(); }

void go_common(LaneRun& run) { run.go(); }

}  // namespace

std::optional<std::array<double, kMaxNeighbours>> neighbouring_iaes(const LinearPlant& plant,
                                                                    std::span<const ParallelPid> controllers,
                                                                    const StepInputs& inputs, const StepResponse& run,
                                                                    Registers registers) {
    const StepSchedule& schedule = run.schedule;
    if (schedule.to_horizon > 0 || schedule.level.empty() || controllers.empty()) return std::nullopt;
    Loops loops(plant, controllers, inputs, schedule);
    const RunSetup& first = loops.setups.front();
    const auto fits = [&](const RunSetup& setup) {
        return setup.system.n == first.system.n && setup.steady.error_integral.has_value();
    };
    if (!std::ranges::all_of(loops.setups, fits)) return std::nullopt;
    const int longest = *std::ranges::max_element(schedule.level);
    if (longest > std::max(first.level_of_L, first.last_mapped)) return std::nullopt;
    LaneRun lanes(loops, inputs, run);
    registers == Registers::avx2 ? go_avx2(lanes) : go_common(lanes);
    return lanes.iaes();
}

}  // namespace tunewright
