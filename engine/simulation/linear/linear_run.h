// A run step by step: chooses step lengths, stores the nodes, and decides when to stop. `Steps` computes a step
// (mapped_steps.h, scaled_steps.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/simulation/linear/delayed_signal.h"
#include "engine/simulation/linear/run_setup.h"
#include "engine/simulation/linear/step_levels.h"
#include "engine/simulation/run/stopping_rule.h"

namespace tunewright {

template <class Steps>
class LinearRun {
public:
    /// `setup` and `options` must outlive this. `own`: further arguments of these steps.
    template <class... Own>
    LinearRun(const RunSetup& setup, const ResponseOptions& options, const Own&... own)
        : setup_(setup),
          options_(options),
          steps_(setup, own..., response_.nodes),
          levels_({.delayed = setup.system.delayed,
                   .h0 = setup.h0,
                   .level_of_L = setup.level_of_L,
                   .echoes = echoes_that_count(std::abs(setup.system.s.N), options.tolerance, kRetardedEchoes),
                   .longest = setup.longest}),
          stopping_(options.settled, setup.system.s.L),
          // Before t = 0 all signals are 0, which is the first deviation from the final rest.
          largest_y_(std::abs(setup.steady.y)),
          largest_u_(std::abs(setup.steady.u)) {
        response_.y_final = setup.steady.y;
        response_.u_final = setup.steady.u;
        response_.schedule.h0 = setup.h0;
        response_.schedule.propagator = steps_.propagator();
    }

    StepResponse run() {
        const StepSchedule* repeat = options_.repeat;
        const std::size_t steps = repeat != nullptr ? repeat->level.size() : kUsualSteps;
        response_.nodes.reserve(steps + kUsualJumps);
        response_.schedule.level.reserve(steps);
        steps_.begin();
        note_node();
        for (int step = 0; repeat != nullptr || step < options_.max_steps; ++step) {
            const bool over = repeat != nullptr && step == static_cast<int>(repeat->level.size());
            if (!over && finished()) return ended();
            if (steps_.escaped()) break;
            if (!over) choose_level(step);
            if (over || reaches_horizon()) {
                go_to_horizon();
                return ended();
            }
            take_step();
        }
        response_.settles = false;
        return ended();
    }

private:
    static constexpr int kRetardedEchoes = 4;    // jumps at 0, L, 2L, ...; the plant smooths them at each passage
    static constexpr double kErrorFloor = 2e-3;  // of the largest deviation: the least reference of relative errors
    static constexpr std::size_t kUsualSteps = 120, kUsualJumps = 16;  // of a run

    double time() const { return levels_.ticks() * setup_.h0; }

    /// Updates the run's state for the node that was added last.
    void note_node() {
        const SteadyState& rest = setup_.steady;
        const ResponseNode& node = response_.nodes.back();
        if (options_.tail && response_.nodes.size() > 1) tail_.add(response_.nodes.end()[-2], node, setup_.system.in.r);
        largest_y_ = std::max(largest_y_, std::abs(node.y - rest.y));
        largest_u_ = std::max(largest_u_, std::abs(node.u - rest.u));
        stopping_.note(node.t, std::abs(node.y - rest.y), largest_y_, std::abs(node.u - rest.u), largest_u_);
    }

    bool finished() const {
        const double t = response_.nodes.back().t;
        if (options_.horizon) return t >= *options_.horizon;
        if (!stopping_.has_settled(t)) return false;
        const std::optional<double>& exact = setup_.steady.error_integral;
        if (!exact) return true;
        const double rest = *exact - steps_.error_integral(), error = setup_.system.in.r - response_.nodes.back().y;
        if (!stopping_.tail_may_end(rest, error, std::max(std::abs(*exact), tail_.absolute_error()))) return false;
        return !options_.tail || tail_.little_is_left(rest, error, t, *options_.tail);
    }

    StepResponse ended() {
        response_.error_integral_final = steps_.final_integral(setup_.steady.error_integral);
        return std::move(response_);
    }

    /// True if a step of the present level ends at or beyond the horizon. Steps longer than the dead time have only
    /// certain lengths, so they are replaced by shorter ones there.
    bool reaches_horizon() {
        if (!options_.horizon) return false;
        const double left = (*options_.horizon - time()) / setup_.h0;
        while (levels_.longer_than_L() && std::ldexp(1.0, levels_.level()) > left) levels_.lower();
        return std::ldexp(1.0, levels_.level()) * (1 + kSameInstant) >= left;
    }

    /// The last steps, which end exactly at the horizon: one, or the number that a repetition requires.
    void go_to_horizon() {
        if (!options_.horizon) return;
        const double from = time(), left = *options_.horizon - from;
        if (!(left > kSameInstant * setup_.h0)) return;
        const int parts = options_.repeat != nullptr ? options_.repeat->to_horizon : 1;
        const double h = left / parts;
        steps_.prepare_last(h);
        for (int i = 1; i <= parts; ++i) {
            steps_.take_last(from + h * (i - 1), i == parts ? *options_.horizon : from + h * i, largest_y_);
            note_node();
        }
        response_.schedule.to_horizon = parts;
    }

    void choose_level(int step) {
        if (options_.repeat != nullptr) return levels_.repeat(options_.repeat->level[static_cast<std::size_t>(step)]);
        const Smoothness found = smoothness();
        const bool long_ones = levels_.longer_than_L();
        levels_.choose(found);
        // Near rest the response becomes smoother: if it is rough there, long steps have made it so from a resonance,
        // and would do so again.
        if (found == Smoothness::rough && long_ones && near_rest()) levels_.go_no_higher();
    }

    bool near_rest() const {
        const auto& now = response_.nodes.back();
        return std::abs(now.y - setup_.steady.y) < kErrorFloor * largest_y_ &&
               std::abs(now.u - setup_.steady.u) < kErrorFloor * largest_u_;
    }

    /// Smoothness of the cubic over the last two steps, relative to the local distance from rest.
    Smoothness smoothness() const {
        const auto& nodes = response_.nodes;
        if (levels_.equal_steps() < 2 || nodes.size() < 3) return Smoothness::unknown;
        const ResponseNode &a = nodes[nodes.size() - 3], &b = nodes[nodes.size() - 2], &c = nodes.back();
        const double h = c.t - a.t;
        const auto fit = [&](Signal start, double middle, Signal end, double rest, double largest) -> Misfit {
            const double scale = std::max({std::abs(start.value - rest), std::abs(middle - rest),
                                           std::abs(end.value - rest), kErrorFloor * largest});
            return {std::abs(middle - hermite_midpoint(h, start, end)), scale};
        };
        const SteadyState& rest = setup_.steady;
        return smoothness_of(
            {fit({a.y, a.y_slope}, b.y, {c.y, c.y_slope}, rest.y, largest_y_),
             fit({a.u, a.u_slope}, b.u, {c.u, c.u_slope}, rest.u, largest_u_), steps_.fit(kErrorFloor * largest_y_)},
            options_.tolerance);
    }

    void take_step() {
        while (!steps_.take(levels_.level(), time(), largest_y_)) levels_.lower();
        response_.schedule.level.push_back(static_cast<signed char>(levels_.level()));
        const bool may_jump = levels_.count();
        note_node();
        if (!may_jump) return;
        steps_.add_jump(time());
        note_node();
        levels_.note_jump();
    }

    const RunSetup& setup_;
    const ResponseOptions& options_;
    StepResponse response_;
    Steps steps_;
    StepLevels levels_;
    StoppingRule stopping_;
    ErrorTail tail_;
    double largest_y_, largest_u_;
};

}  // namespace tunewright
