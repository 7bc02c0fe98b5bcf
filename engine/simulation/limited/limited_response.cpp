#include "engine/simulation/limited/limited_response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "engine/simulation/limited/limited_course.h"
#include "engine/simulation/limited/limited_loop.h"
#include "engine/simulation/linear/long_step.h"
#include "engine/simulation/linear/response_end.h"
#include "engine/simulation/linear/run_setup.h"
#include "engine/simulation/run/delayed_input.h"
#include "engine/simulation/run/loop_sizes.h"
#include "engine/simulation/run/stopping_rule.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kRetardedEchoes = 4;                 // echoes of a jump: the plant smooths it at each passage
constexpr double kTimeResolution = 128;            // multiple of the rounding of t: the shortest step
constexpr double kRestRounding = 1e-5;             // multiple of `settled`, of the value at rest: smaller deviations
                                                   // count as 0
constexpr double kMinTimeShareForRounding = 1e-3;  // of the first step: least t for the rounding near t = 0
constexpr double kLengthTolerance = 1e-9;          // relative: a stride equals the dead time up to rounding
constexpr double kStepShareToStop = 0.75;          // of the distance to the next stop: a longer step goes exactly to
                                                   // the stop
constexpr int kMaxLevel = 200;                     // keeps lengths finite
constexpr double kCommandRounding = 1e-11;  // of the largest command: it must exceed a limit by this to have crossed it
constexpr int kCorrections = 3;  // exact steps that refine a crossing found on the cubic; each squares its error
constexpr double kMaxCorrectionShare = 0.1;   // of the stride: a longer correction means that the command has no clear
                                              // slope
constexpr double kCrossingTolerance = 1e-14;  // of the largest command: rounding
constexpr double kErrorFloor = 2e-3;          // of the largest deviation: the least reference of relative errors
constexpr double kMaxErrorShareToDouble = 1.0 / 40;  // of the tolerance: below it a step of twice the length is still
                                                     // accurate enough

/// |y| of a response that grows without bound: more than the actuator can cause.
double beyond_bounds(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in,
                     const ActuatorLimits& limits, double y_rest) {
    StepInputs all{in.r, std::abs(in.d)};
    for (const double limit : {limits.min, limits.max})
        if (std::isfinite(limit)) all.d += std::abs(limit);
    return kMaxResponseRatio * std::max(std::abs(y_rest), loop_sizes(own_gain(plant, controller), controller, all).y);
}

/// Error of the cubic through a and c at the midpoint b, in value and slope.
double miss(double h, Signal a, Signal b, Signal c) {
    const double value = hermite_midpoint(h, a, c);
    const double slope = 1.5 * (c.value - a.value) / h - 0.25 * (a.slope + c.slope);
    return std::max(std::abs(b.value - value), h * std::abs(b.slope - slope) / 8);
}

/// Steps of one length in one region.
struct Stride {
    double h = 0;
    bool longer_than_L = false;
    ExactStep whole;                   // of length h; or, beyond L, of length L
    ExactStep rest;                    // h - L, at a limit
    std::optional<LongStep> implicit;  // within the limits, beyond L
};

/// The loop at one instant.
struct LoopInstant {
    double t = 0;
    std::vector<double> x;
    LoopOutput out;
};

/// The run: chooses step lengths, finds the crossings of the limits, stores the nodes, and decides when to stop.
class LimitedRun {
public:
    LimitedRun(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in, LimitedCourse course,
               const ActuatorLimits& limits, const ResponseOptions& options)
        : loop_(course.system, tracking_gain_of(plant, controller), in, limits),
          system_(make_response_system(course.system, in)),
          filter_(controller.filter),
          in_(in),
          limits_(limits),
          options_(options),
          jumps_(std::move(course.jumps)),
          rest_(course.rest),
          beyond_(beyond_bounds(plant, controller, course.largest, limits, rest_.y)),
          history_(response_.nodes, in.d),
          echoes_(echoes_that_count(std::abs(loop_.system().N), options.tolerance, kRetardedEchoes)),
          stopping_(options.settled, loop_.dead_time()) {
        choose_h0(plant, controller);
    }

    StepResponse run() {
        now_.x.assign(Index(loop_.states()), 0.0);
        pass_jumps();
        enter(loop_.region(now_.x, {}), {});
        add_echo(loop_.dead_time(), 0);
        while (static_cast<int>(response_.nodes.size()) < options_.max_steps) {
            if (!take_step() || escaped()) break;
            if (finished()) return ended(true);
        }
        return ended(false);
    }

private:
    void choose_h0(const LinearPlant& plant, const ParallelPid& controller) {
        h0_ = first_step(system_, fastest_rate(system_, plant, controller));
        if (!std::isfinite(h0_)) h0_ = 1;
    }

    double slack() const { return kTimeResolution / 4 * kEpsilon * std::max(now_.t, loop_.dead_time()); }

    /// Adds a future jump or kink of the delayed signal.
    void add_echo(double t, int passages) {
        if (loop_.delayed()) echoes_.add(t, passages, slack());
    }

    void push(const LoopInstant& p) {
        ResponseNode node{.t = p.t,
                          .y = p.out.y.value,
                          .y_slope = p.out.y.slope,
                          .u = p.out.u.value,
                          .u_slope = p.out.u.slope,
                          .error_integral = -p.x.back()};
        response_.nodes.push_back(node);
    }

    void note(const LoopInstant& p) {
        push(p);
        if (const auto& nodes = response_.nodes; options_.tail && nodes.size() > 1)
            tail_.add(nodes[nodes.size() - 2], nodes.back(), in_.r);
        const double dy = std::abs(p.out.y.value - rest_.y), du = std::abs(p.out.u.value - rest_.u);
        largest_y_ = std::max(largest_y_, dy);
        largest_u_ = std::max(largest_u_, du);
        largest_command_ = std::max(largest_command_, std::abs(p.out.command.value));
        // If the loop is at rest from the beginning (for example with u at a limit), the largest deviation is only
        // rounding.
        const double size_y = std::max(largest_y_, kRestRounding * std::abs(rest_.y)),
                     size_u = std::max(largest_u_, kRestRounding * std::abs(rest_.u));
        stopping_.note(p.t, dy, size_y, du, size_u);
    }

    /// Continues from now in this region.
    void enter(Region region, Signal v) {
        region_ = region;
        now_.out = loop_.output(region, now_.x, v);
        note(now_);
    }

    bool escaped() const { return std::abs(now_.out.y.value) > beyond_; }

    bool finished() const {
        if (options_.horizon) return now_.t + slack() >= *options_.horizon;
        if (!rest_.exists || next_jump_ < jumps_.size()) return false;
        if (!stopping_.has_settled(now_.t)) return false;
        const auto remaining = remaining_error_integral();
        if (!remaining) return true;
        const double so_far = response_.nodes.back().error_integral;
        const double error = in_.r - now_.out.y.value;
        if (!stopping_.tail_may_end(*remaining, error, std::abs(so_far) + std::abs(*remaining))) return false;
        return !options_.tail || tail_.little_is_left(*remaining, error, now_.t, *options_.tail);
    }

    /// For an infinite horizon, once the loop stays within the limits: the remaining change of the integral's state.
    std::optional<double> remaining_error_integral() const {
        if (!rest_.error_integral || region_ != Region::inside) return std::nullopt;
        return *rest_.error_integral - error_integral_in_states(loop_.system(), filter_, now_.x);
    }

    StepResponse ended(bool by_rule) {
        const ResponseNode& last = response_.nodes.back();
        response_.settles = by_rule;
        const bool at_rest = by_rule && rest_.exists;
        response_.y_final = at_rest ? rest_.y : last.y;
        response_.u_final = at_rest ? rest_.u : last.u;
        if (const auto remaining = remaining_error_integral(); at_rest && remaining)
            response_.error_integral_final = last.error_integral + *remaining;
        return std::move(response_);
    }

    // ---- one step -----------------------------------------------------------------------------------------------

    Stride make_stride(double h) const {
        Stride stride;
        stride.h = h;
        const double L = loop_.dead_time();
        stride.longer_than_L = loop_.delayed() && h > L * (1 + kLengthTolerance);
        stride.whole = loop_.step(region_, stride.longer_than_L ? L : h);
        if (!stride.longer_than_L) return stride;
        if (region_ == Region::inside)
            stride.implicit.emplace(system_, stride.whole, loop_.step(region_, h - L));
        else
            stride.rest = loop_.step(region_, h - L);
        return stride;
    }

    const Stride& stride_of_level(int level) {
        auto& kept = strides_[static_cast<Index>(region_)];
        const auto found = kept.find(level);
        if (found != kept.end()) return found->second;
        return kept.emplace(level, make_stride(std::ldexp(h0_, level))).first->second;
    }

    /// Takes one stride from `from` in the present region. Returns the error of the delayed signal's cubic at its
    /// midpoint.
    double advance(const LoopInstant& from, const Stride& stride, LoopInstant& to) {
        to.t = from.t + stride.h;
        to.x = from.x;
        if (!loop_.delayed()) {
            tunewright::advance(stride.whole, {}, to.x);
            to.out = loop_.output(region_, to.x, {});
            return 0;
        }
        const double L = loop_.dead_time(), start = from.t - L, first = std::min(stride.h, L);
        const Signal v0 = history_.at(start, slack()).after;
        const Signal w0 = {from.out.u.value + in_.d, from.out.u.slope};
        const Signal v1 = stride.longer_than_L ? w0 : history_.at(start + first, slack()).before;
        const double missed = miss(first, v0, history_.at(start + 0.5 * first, slack()).after, v1);
        if (stride.implicit) {
            stride.implicit->start(v0, w0, from.x, start_);
            to.out = loop_.output(region_, to.x, stride.implicit->finish(start_, {}, to.x));
            return missed;
        }
        tunewright::advance(stride.whole, hermite_taylor(first, v0, v1), to.x);
        // At a limit the plant's input is constant.
        if (stride.longer_than_L) tunewright::advance(stride.rest, {w0.value, 0, 0, 0}, to.x);
        to.out = loop_.output(region_, to.x, stride.longer_than_L ? Signal{w0.value, 0} : v1);
        return missed;
    }

    /// Relative to the local deviation from rest.
    double interpolation_error(double h, double missed_by_delay) const {
        const auto relative = [&](Signal a, Signal b, Signal c, double rest, double largest) {
            const double size = std::max(
                {std::abs(a.value - rest), std::abs(b.value - rest), std::abs(c.value - rest), kErrorFloor * largest});
            return size > 0 ? miss(h, a, b, c) / size : 0;
        };
        double error = relative(now_.out.y, middle_.out.y, end_.out.y, rest_.y, largest_y_);
        error = std::max(error, relative(now_.out.command, middle_.out.command, end_.out.command, rest_.u,
                                         std::max(largest_u_, largest_command_)));
        if (missed_by_delay > 0) {
            const double size = std::max({std::abs(now_.out.u.value - rest_.u), std::abs(end_.out.u.value - rest_.u),
                                          kErrorFloor * std::max(largest_u_, std::abs(in_.d))});
            error = std::max(error, size > 0 ? missed_by_delay / size : kInfinity);
        }
        return error;
    }

    double distance_to_next_stop() const {
        double distance = echoes_.next().value_or(kInfinity) - now_.t;
        if (next_jump_ < jumps_.size()) distance = std::min(distance, jumps_[next_jump_].t - now_.t);
        if (options_.horizon) distance = std::min(distance, *options_.horizon - now_.t);
        return distance;
    }

    /// False if no finite step is possible.
    bool take_step() {
        const double distance = distance_to_next_stop();
        const double shortest = kTimeResolution * kEpsilon * std::max(now_.t, kMinTimeShareForRounding * h0_);
        Stride cut;
        while (true) {
            const double wanted = std::ldexp(h0_, level_);
            const bool to_stop = wanted >= kStepShareToStop * distance;
            if (to_stop) cut = make_stride(0.5 * distance);
            const Stride& stride = to_stop ? cut : stride_of_level(level_ - 1);
            const Index kept = response_.nodes.size();
            double missed = advance(now_, stride, middle_);
            push(middle_);
            missed = std::max(missed, advance(middle_, stride, end_));
            response_.nodes.resize(kept);
            const double error = interpolation_error(2 * stride.h, missed);
            const bool finite = std::isfinite(error) && std::isfinite(end_.x.back());
            if (!(finite && error <= options_.tolerance) && 2 * stride.h > shortest) {
                level_ = to_stop ? std::ilogb(distance / h0_) - 1 : level_ - 1;
                continue;
            }
            if (!finite) return false;
            if (crosses(now_, middle_)) return cross(now_, middle_, stride.h);
            note(middle_);
            if (crosses(middle_, end_)) return cross(LoopInstant(middle_), end_, stride.h);
            const bool at_stop = to_stop;
            if (!to_stop && error < kMaxErrorShareToDouble * options_.tolerance && level_ < kMaxLevel) ++level_;
            std::swap(now_, end_);
            note(now_);
            if (at_stop) pass_echo();
            return true;
        }
    }

    // ---- crossings and breaks -----------------------------------------------------------------------------------

    struct Crossing {
        double s = 0;
        bool at_max = false;
    };

    std::optional<Crossing> crosses(const LoopInstant& a, const LoopInstant& b) const {
        const double h = b.t - a.t;
        const auto c = hermite_taylor(h, a.out.command, b.out.command);
        const double noise =
            kCommandRounding * std::max({largest_command_, std::abs(a.out.command.value), std::abs(c[0])});
        const auto rise = [&](double limit, double sign) -> std::optional<double> {
            if (!std::isfinite(limit)) return std::nullopt;
            return first_rise({sign * (c[0] - limit), sign * c[1], sign * c[2], sign * c[3]}, h, noise);
        };
        std::optional<double> up, down;
        if (region_ != Region::below) up = rise(limits_.max, region_ == Region::inside ? 1 : -1);
        if (region_ != Region::above) down = rise(limits_.min, region_ == Region::inside ? -1 : 1);
        if (up && (!down || *up <= *down)) return Crossing{*up, true};
        if (down) return Crossing{*down, false};
        return std::nullopt;
    }

    /// Steps from `from` to the crossing before `to`, which is found on the cubic and refined with exact steps.
    bool cross(const LoopInstant& from, const LoopInstant& to, double h) {
        const Crossing crossing = *crosses(from, to);
        const double limit = crossing.at_max ? limits_.max : limits_.min;
        const double shortest =
            std::min(0.5 * h, kTimeResolution * kEpsilon * std::max(from.t, kMinTimeShareForRounding * h0_));
        double s = std::clamp(crossing.s, shortest, h);
        LoopInstant at;
        for (int i = 0;; ++i) {
            advance(from, make_stride(s), at);
            const double gap = limit - at.out.command.value, correction = gap / at.out.command.slope;
            if (i == kCorrections || !(std::abs(correction) < kMaxCorrectionShare * h)) break;
            if (std::abs(gap) <= kCrossingTolerance * largest_command_) break;
            const double next = std::clamp(s + correction, shortest, h);
            if (next == s) break;
            s = next;
        }
        now_ = std::move(at);
        note(now_);
        const Signal v = loop_.delayed() ? history_.at(now_.t - loop_.dead_time(), slack()).after : Signal{};
        enter(loop_.region_after(region_, crossing.at_max), v);
        add_echo(now_.t + loop_.dead_time(), 1);
        pass_echo();
        return true;
    }

    /// At an echo the delayed signal may jump, and so may the command; at a jump of the states too.
    void pass_echo() {
        const auto passages = echoes_.pass(now_.t + slack());
        const bool jumped = pass_jumps();
        if (!passages && !jumped) return;
        const Signal v = loop_.delayed() ? history_.at(now_.t - loop_.dead_time(), slack()).after : Signal{};
        const Region before = region_;
        enter(loop_.region(now_.x, v), v);
        add_echo(now_.t + loop_.dead_time(), passages && !jumped && region_ == before ? *passages + 1 : 0);
        if (!jumped) return;
        stopping_.start_again(now_.t);
        level_ = 0;
    }

    /// True if a state jumps now.
    bool pass_jumps() {
        const Index before = next_jump_;
        for (; next_jump_ < jumps_.size() && jumps_[next_jump_].t <= now_.t + slack(); ++next_jump_)
            now_.x[Index(jumps_[next_jump_].state)] += jumps_[next_jump_].change;
        return next_jump_ > before;
    }

    LimitedLoop loop_;
    ResponseSystem system_;  // within the limits
    Filter filter_;
    StepInputs in_;
    ActuatorLimits limits_;
    const ResponseOptions& options_;
    std::vector<StateJump> jumps_;
    Index next_jump_ = 0;
    SteadyState rest_;
    double beyond_;
    StepResponse response_;
    InputHistory history_;
    std::array<std::map<int, Stride>, 3> strides_;  // of each region, by level: length h0 2^level
    Echoes echoes_;
    LongStep::Start start_;
    double h0_ = 1;
    int level_ = 0;
    Region region_ = Region::inside;
    LoopInstant now_, middle_, end_;
    double largest_y_ = 0, largest_u_ = 0, largest_command_ = 0;
    StoppingRule stopping_;
    ErrorTail tail_;
};

}  // namespace

StepResponse simulate_limited(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs,
                              const ActuatorLimits& limits, const ResponseOptions& options) {
    return LimitedRun(plant, controller, inputs,
                      {.system = make_delay_system(plant, controller),
                       .jumps = {},
                       .rest = within_limits(steady_state(plant, controller, inputs), plant, limits, inputs.d),
                       .largest = inputs},
                      limits, options)
        .run();
}

StepResponse simulate_limited_course(const LinearPlant& plant, const ParallelPid& controller,
                                     const LimitedCourse& course, const ActuatorLimits& limits,
                                     const ResponseOptions& options) {
    return LimitedRun(plant, controller, {}, course, limits, options).run();
}

}  // namespace tunewright
