#include "engine/simulation/linear/linear_response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>

#include "engine/controller/pid.h"
#include "engine/numerics/propagator.h"
#include "engine/simulation/linear/long_step.h"
#include "engine/simulation/linear/response_end.h"
#include "engine/simulation/linear/step_levels.h"
#include "engine/simulation/run/delayed_input.h"
#include "engine/simulation/run/stopping_rule.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr int kRetardedEchoes = 4;                     // jumps at 0, L, 2L, ...: smoothed by the plant at each passage
constexpr int kRepetitions = 20;                       // of a step that sees its own end through the scaled integral
constexpr double kConverged = 1e-10;                   // of the response's size
constexpr double kSameInstant = 1e-9;                  // of the shortest step: nearer instants are one
constexpr double kFloor = 2e-3;                        // of the largest deviation: errors are relative to at least that
constexpr int kLeastLevelOfL = 3, kMostLevelOfL = 30;  // of steps a dead time, as a power of 2
constexpr double kOfGrowth = 0.25;                     // of an unstable mode's time: the longest step
constexpr std::size_t kUsualSteps = 120, kUsualJumps = 16;  // of a run

/// Chooses step lengths, keeps the nodes, knows when to stop.
class LinearRun {
public:
    LinearRun(const LinearPlant& plant, const ParallelPid& controller, const ErrorScaling* scaling,
              const StepInputs& in, const ResponseOptions& options)
        : system_(make_response_system(plant, controller, in)),
          scaling_(system_.s.integral_state >= 0 ? scaling : nullptr),
          options_(options),
          steady_(steady_outputs(plant, controller, in)),
          propagator_(system_.n, system_.F, input(), system_.b, choose_h0(plant, controller)),
          history_(response_.nodes, in.d),
          levels_({.delayed = system_.delayed,
                   .h0 = propagator_.h0(),
                   .level_of_L = level_of_L_,
                   .echoes = echoes_that_count(std::abs(system_.s.N), options.tolerance, kRetardedEchoes),
                   .longest = longest_step(plant)}),
          stopping_(options.settled, system_.s.L) {
        if (scaling_ != nullptr) add_scaling(plant);
        // Before t = 0 everything is 0: that is the first deviation from where the loop comes to rest.
        largest_y_ = std::abs(steady_.y);
        largest_u_ = std::abs(steady_.u);
        response_.y_final = steady_.y;
        response_.u_final = steady_.u;
        response_.error_integral_final = steady_.error_integral;
    }

    StepResponse run() {
        x_.assign(Index(system_.n), 0.0);
        const std::size_t steps = options_.repeat != nullptr ? options_.repeat->level.size() : kUsualSteps;
        response_.nodes.reserve(steps + kUsualJumps);
        response_.schedule.level.reserve(steps);
        scale(add(node_at(system_, 0, x_, {})));
        note_node();
        response_.schedule.h0 = propagator_.h0();
        for (int step = 0; options_.repeat != nullptr || step < options_.max_steps; ++step) {
            const bool over = options_.repeat != nullptr && step == static_cast<int>(options_.repeat->level.size());
            if (!over && finished()) return ended();
            if (escaped()) break;
            if (!over) choose_level(step);
            if (over || reaches_horizon()) {
                go_to_horizon();
                return ended();
            }
            while (!take_step()) levels_.lower();
            response_.schedule.level.push_back(static_cast<signed char>(levels_.level()));
        }
        response_.settles = false;
        return ended();
    }

private:
    /// What comes into the steps as a cubic: the delayed signal, or what scaling adds to the integral's input.
    std::vector<double> input() const {
        if (system_.delayed || scaling_ == nullptr) return system_.G;
        std::vector<double> into_integral(Index(system_.n), 0.0);
        into_integral[Index(system_.s.integral_state)] = 1;
        return into_integral;
    }

    void add_scaling(const LinearPlant& plant) {
        const auto i = Index(system_.s.integral_state);
        into_u_ = system_.s.M[i];
        into_y_ = system_.s.Y[i];
        const double time = plant.dead_time() + propagator_.h0();
        escape_ = kEscaped * std::max({std::abs(system_.in.r), scaling_->delta_r, std::abs(steady_.y),
                                       std::abs(system_.in.d) * std::abs(plant.rational({0, 1 / time}))});
    }

    /// Adds to a node's slopes what scaling changes in them.
    void scale(ResponseNode& node) {
        if (scaling_ == nullptr) return;
        const double e = system_.in.r - node.y;
        excess_.value = scaling_->excess(e);
        node.y_slope += into_y_ * excess_.value;
        node.u_slope += into_u_ * excess_.value;
        excess_.slope = -scaling_->excess_slope(e) * node.y_slope;
    }

    bool escaped() const { return scaling_ != nullptr && !(std::abs(response_.nodes.back().y) <= escape_); }
    /// An unstable plant's own modes amplify what a step gets wrong: no step may be long for them.
    static double longest_step(const LinearPlant& plant) {
        double longest = std::numeric_limits<double>::infinity();
        for (const auto pole : plant.poles())
            if (pole.real() > 0) longest = std::min(longest, kOfGrowth / pole.real());
        return longest;
    }

    double choose_h0(const LinearPlant& plant, const ParallelPid& controller) {
        if (options_.repeat != nullptr) {
            level_of_L_ =
                system_.delayed ? static_cast<int>(std::lround(std::log2(system_.s.L / options_.repeat->h0))) : 0;
            return options_.repeat->h0;
        }
        double fastest = fastest_rate(system_, plant, controller);
        if (!system_.delayed) {
            // The rates of the single states count beside the loop's own.
            for (int i = 0; i < system_.s.n; ++i)
                fastest = std::max(fastest, std::abs(system_.s.F[Index(i * system_.s.n + i)]));
            return first_step(system_, std::max(fastest, std::numeric_limits<double>::min()));
        }
        const double doublings = std::log2(system_.s.L / first_step(system_, fastest));
        level_of_L_ = std::clamp(static_cast<int>(std::ceil(doublings)), kLeastLevelOfL, kMostLevelOfL);
        return std::ldexp(system_.s.L, -level_of_L_);
    }

    /// In its place at once: a node on its way there would be copied from memory that has just been written.
    ResponseNode& add(const ResponseNode& node) { return response_.nodes.emplace_back() = node; }

    /// What the run keeps in mind of the node that was added last, its slopes scaled.
    void note_node() {
        const ResponseNode& node = response_.nodes.back();
        if (options_.tail && response_.nodes.size() > 1) tail_.add(response_.nodes.end()[-2], node, system_.in.r);
        if (scaling_ != nullptr) excesses_.push_back(excess_);
        largest_y_ = std::max(largest_y_, std::abs(node.y - steady_.y));
        largest_u_ = std::max(largest_u_, std::abs(node.u - steady_.u));
        stopping_.note(node.t, std::abs(node.y - steady_.y), largest_y_, std::abs(node.u - steady_.u), largest_u_);
    }

    bool finished() const {
        const double t = response_.nodes.back().t;
        if (options_.horizon) return t >= *options_.horizon;
        if (!stopping_.has_settled(t)) return false;
        if (!steady_.error_integral) return true;
        const double rest = error_integral_left(), error = system_.in.r - response_.nodes.back().y;
        const double whole = std::max(std::abs(*steady_.error_integral), tail_.absolute_error());
        if (!stopping_.tail_may_end(rest, error, whole)) return false;
        return !options_.tail || tail_.little_is_left(rest, error, t, *options_.tail);
    }

    /// From now to infinity. Scaled, the integral's state has that to go: near the end it sees the error as it is.
    double error_integral_left() const {
        const double so_far = scaling_ ? x_[Index(system_.s.integral_state)] : response_.nodes.back().error_integral;
        return *steady_.error_integral - so_far;
    }

    StepResponse ended() {
        if (scaling_ != nullptr && steady_.error_integral)
            response_.error_integral_final = response_.nodes.back().error_integral + error_integral_left();
        return std::move(response_);
    }

    /// Whether a step of the present level ends on the horizon or beyond it. Steps longer than the dead time, which
    /// have only some lengths, give way to shorter ones there.
    bool reaches_horizon() {
        if (!options_.horizon) return false;
        const double left = (*options_.horizon - time()) / propagator_.h0();
        while (levels_.longer_than_L() && std::ldexp(1.0, levels_.level()) > left) levels_.lower();
        return std::ldexp(1.0, levels_.level()) * (1 + kSameInstant) >= left;
    }

    /// The last steps, which end exactly there: one, or as many as a repetition asks for.
    void go_to_horizon() {
        if (!options_.horizon) return;
        const double from = time(), left = *options_.horizon - from;
        if (!(left > kSameInstant * propagator_.h0())) return;
        const int parts = options_.repeat != nullptr ? options_.repeat->to_horizon : 1;
        const ExactStep step = propagator_.step(left / parts);
        for (int i = 1; i <= parts; ++i) {
            const double end = i == parts ? *options_.horizon : from + step.h * i;
            if (system_.delayed)
                take_short_step(step, end);
            else
                take_closed_step(step, end, true);
            note_node();
        }
        response_.schedule.to_horizon = parts;
    }

    void choose_level(int step) {
        if (options_.repeat != nullptr) return levels_.repeat(options_.repeat->level[Index(step)]);
        const Smoothness found = smoothness();
        const bool long_ones = levels_.longer_than_L();
        levels_.choose(found);
        // The way to rest becomes smoother: what is rough there, long steps have made of a resonance, and would again.
        if (found == Smoothness::rough && long_ones && near_rest()) levels_.go_no_higher();
    }

    bool near_rest() const {
        const auto& now = response_.nodes.back();
        return std::abs(now.y - steady_.y) < kFloor * largest_y_ && std::abs(now.u - steady_.u) < kFloor * largest_u_;
    }

    /// Of the cubic over the last two steps, relative to the local distance from rest.
    Smoothness smoothness() const {
        const auto& nodes = response_.nodes;
        if (levels_.equal_steps() < 2 || nodes.size() < 3) return Smoothness::unknown;
        const ResponseNode &a = nodes[nodes.size() - 3], &b = nodes[nodes.size() - 2], &c = nodes.back();
        const double h = c.t - a.t;
        const auto fit = [&](Signal start, double middle, Signal end, double rest, double largest) -> Misfit {
            const double scale = std::max(
                {std::abs(start.value - rest), std::abs(middle - rest), std::abs(end.value - rest), kFloor * largest});
            return {std::abs(middle - hermite_midpoint(h, start, end)), scale};
        };
        const Misfit y = fit({a.y, a.y_slope}, b.y, {c.y, c.y_slope}, steady_.y, largest_y_),
                     u = fit({a.u, a.u_slope}, b.u, {c.u, c.u_slope}, steady_.u, largest_u_);
        return smoothness_of({y, u, scaling_ != nullptr ? fit_of_excess() : Misfit()}, options_.tolerance);
    }

    /// Of the last two steps' cubic, against the local error of control.
    Misfit fit_of_excess() const {
        const Index last = excesses_.size() - 1;
        const Signal &a = excesses_[last - 2], &b = excesses_[last - 1], &c = excesses_[last];
        const auto& nodes = response_.nodes;
        double size = kFloor * largest_y_;
        for (Index i = last - 2; i <= last; ++i) size = std::max(size, std::abs(nodes[i].y - system_.in.r));
        const double h = nodes[last].t - nodes[last - 2].t;
        return {std::abs(b.value - hermite_midpoint(h, a, c)), size};
    }

    /// False: the step is too long for the scaled integral, and nothing has happened.
    bool take_step() {
        if (levels_.longer_than_L()) {
            if (!take_long_step()) return false;
        } else {
            const ExactStep& step = propagator_.level(levels_.level());
            const double end = time() + step.h;
            if (system_.delayed)
                take_short_step(step, end);
            else if (!take_closed_step(step, end, levels_.level() == 0))
                return false;
        }
        const bool may_jump = levels_.count();
        note_node();
        if (may_jump) add_jump();
        return true;
    }

    /// Up to the dead time: the delayed signal is known.
    void take_short_step(const ExactStep& step, double end) {
        const Signal v0 = delayed_to(end - step.h);
        const auto [v1, after] = history_.at(end - system_.s.L, slack());
        delayed_end_ = end;
        delayed_after_ = after;
        advance(step, hermite_taylor(step.h, v0, v1), x_);
        ResponseNode& node = add(node_at(system_, end, x_, v1));
        if (scaling_ != nullptr) add_excess(step.h, node);
    }

    double slack() const { return kSameInstant * propagator_.h0(); }
    /// The delayed signal at the start of a step, after a jump there.
    Signal delayed_to(double t) {
        if (std::abs(delayed_end_ - t) <= slack()) return delayed_after_;
        return history_.at(t - system_.s.L, slack()).after;
    }

    /// The delayed signal may jump now, and with it u.
    void add_jump() {
        scale(add(node_at(system_, time(), x_, delayed_to(time()))));
        note_node();
        levels_.note_jump();
    }

    /// The integral's state and u after a step within which y does not depend on them.
    void add_excess(double h, ResponseNode& node) {
        const Signal before = excess_;
        scale(node);
        const double added = hermite_integral(h, before, excess_);
        x_[Index(system_.s.integral_state)] += added;
        node.u += into_u_ * added;
    }

    /// Longer than the dead time.
    bool take_long_step() {
        const LongStep& step = long_step();
        const double end = time() + step.h();
        const ResponseNode& now = response_.nodes.back();
        step.start(delayed_to(time()), {now.u + system_.in.d, now.u_slope}, x_, start_);
        return settle(step.h(), false, [&](double added, std::vector<double>& x, ResponseNode& at_end) {
            const Signal v =
                step.finish(start_, {into_u_ * added, into_u_ * excess_.value, into_u_ * excess_.slope}, x);
            if (scaling_ != nullptr) x[Index(system_.s.integral_state)] += added;
            at_end = node_at(system_, end, x, v);
        });
    }

    /// Without dead time.
    bool take_closed_step(const ExactStep& step, double end, bool shortest) {
        const Signal before = excess_;
        return settle(step.h, shortest, [&](double, std::vector<double>& x, ResponseNode& at_end) {
            x = x_;
            advance(step, hermite_taylor(step.h, before, excess_), x);
            at_end = node_at(system_, end, x, {});
        });
    }

    /// Finds the end of a step whose y depends on the integral's own input by repetition: `try_end` goes to the end
    /// with the excess assumed there. False where that does not converge, which a shorter step cures; the `shortest` is
    /// accepted all the same.
    template <class TryEnd>
    bool settle(double h, bool shortest, const TryEnd& try_end) {
        end_x_.resize(x_.size());
        ResponseNode& node = response_.nodes.emplace_back();
        const Signal before = excess_;
        if (scaling_ == nullptr) {
            try_end(0, end_x_, node);
            x_.swap(end_x_);
            return true;
        }
        excess_.value += h * before.slope;
        for (int i = 0; i < kRepetitions; ++i) {
            const Signal assumed = excess_;
            try_end(hermite_integral(h, before, assumed), end_x_, node);
            scale(node);
            const double change =
                std::max(std::abs(excess_.value - assumed.value), h * std::abs(excess_.slope - assumed.slope));
            if (change > kConverged * std::max(largest_y_, std::abs(system_.in.r))) continue;
            x_.swap(end_x_);
            return true;
        }
        if (!shortest) {
            excess_ = before;
            response_.nodes.pop_back();
            return false;
        }
        x_.swap(end_x_);
        return true;
    }

    const LongStep& long_step() {
        const int beyond = levels_.level() - level_of_L_;
        if (long_steps_.empty()) {
            const ExactStep& over_L = propagator_.level(level_of_L_);
            long_steps_.emplace_back(system_, over_L, over_L);
        }
        while (static_cast<int>(long_steps_.size()) < beyond) long_steps_.emplace_back(propagator_, long_steps_.back());
        return long_steps_[Index(beyond - 1)];
    }

    double time() const { return levels_.ticks() * propagator_.h0(); }

    ResponseSystem system_;
    const ErrorScaling* scaling_;
    const ResponseOptions& options_;
    SteadyState steady_;
    int level_of_L_ = 0;
    Propagator propagator_;
    StepResponse response_;
    InputHistory history_;
    // The delayed signal at the end of the last step that looked it up, after a jump there.
    double delayed_end_ = -std::numeric_limits<double>::infinity();
    Signal delayed_after_;
    StepLevels levels_;
    StoppingRule stopping_;
    std::deque<LongStep> long_steps_;  // of level_of_L_ + 1, ...
    LongStep::Start start_;
    std::vector<double> x_, end_x_;
    Signal excess_;                 // phi(e) - e at the last node
    std::vector<Signal> excesses_;  // of each node
    double into_u_ = 0, into_y_ = 0, escape_ = 0;
    double largest_y_ = 0, largest_u_ = 0;
    ErrorTail tail_;
};

}  // namespace

StepResponse simulate_linear(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs,
                             const ResponseOptions& options) {
    return LinearRun(plant, controller, nullptr, inputs, options).run();
}

StepResponse simulate_npid(const LinearPlant& plant, const ParallelPid& linear_part, double delta_r,
                           const StepInputs& inputs, const ResponseOptions& options) {
    const ErrorScaling scaling{delta_r};
    return LinearRun(plant, linear_part, &scaling, inputs, options).run();
}

}  // namespace tunewright
