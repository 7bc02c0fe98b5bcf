#include "engine/simulation/sampled/sampled_response.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <utility>
#include <vector>

#include "engine/loop/sampled/held_plant.h"
#include "engine/simulation/linear/response_recorder.h"
#include "engine/simulation/nonlinear/nonlinear_loop.h"
#include "engine/simulation/nonlinear/plant_run.h"
#include "engine/simulation/run/held_motion.h"
#include "engine/simulation/run/loop_sizes.h"
#include "engine/simulation/run/stopping_rule.h"
#include "engine/simulation/sampled/sampled_course.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr int kMaxHalvings = 12;            // of a piece, before a node is added without a further check
constexpr Index kMaxNodes = 1000000;        // beyond it no piece is halved any more
constexpr double kProbeShare = 0.309;       // of a piece: a second check at this point notices oscillations of which
                                            // the midpoint shows nothing
constexpr double kInstantTolerance = 1e-9;  // of a sample: closer times are equal
constexpr int kRestSamples = 10;            // in addition to the dead time: the least time that a response must have
                                            // rested

/// The rest of the loop without the limits of the program.
SteadyState rest_of(const LinearPlant& plant, const ParallelPid& gains, const StepInputs& in) {
    const double gain = plant.low_frequency_gain();
    const int integrators = plant.integrators();
    if (integrators < 0) return {gains.Ki == 0 || in.r == 0, 0, gains.Ki == 0 ? gains.Kp * gains.b * in.r : -in.d};
    if (gains.Ki != 0) return {true, in.r, integrators > 0 ? -in.d : in.r / gain - in.d};
    const double u0 = gains.Kp * gains.b * in.r;
    if (integrators > 0) return {gains.Kp != 0, (u0 + in.d) / gains.Kp, -in.d};
    const double y = gain * (u0 + in.d) / (1 + gain * gains.Kp);
    return {std::isfinite(y), y, u0 - gains.Kp * y};
}

/// A part of a sample period within which the plant's input and the output's value are constant.
struct Piece {
    double from = 0;                     // start within the period
    std::vector<HeldStep> whole, probe;  // the latter up to kProbeShare of it
    bool arrived;                        // u_{k-d} drives the plant here; before it u_{k-d-1}
    bool given;  // true: the output is u_{k-o}, with o whole samples of computation delay; false: it is u_{k-o-1}
};

class SampledRun {
public:
    SampledRun(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits, const StepInputs& inputs,
               SampledCourse course, const SampledOptions& options);
    StepResponse result();

private:
    void run_changing(Piece& piece, double t, double t_end, double v, double u);
    bool changes_before(double t) const {
        return next_jump_ < course_.jumps.size() && course_.jumps[next_jump_].t < t - kInstantTolerance * law_.Ts;
    }
    double setpoint(double t) const { return course_.setpoint ? course_.setpoint(t) : in_.r; }
    std::vector<Piece> pieces() const;
    double input(int k, bool arrived) const { return past(k - to_plant_.whole - (arrived ? 0 : 1)); }
    double output(int k, bool given) const { return past(k - computed_.whole - (given ? 0 : 1)); }
    double past(int k) const { return k < 0 ? 0 : u_[static_cast<Index>(k)]; }
    void sample(int k);
    void run_period(int k);
    bool ends_by(double t) const { return t >= end_ - kInstantTolerance * law_.Ts; }
    Piece piece(double from, double h, bool arrived, bool given) const {
        return {from, {motion_.step(h)}, {motion_.step(kProbeShare * h)}, arrived, given};
    }
    const HeldStep& halved(std::vector<HeldStep>& steps, int level) const {
        while (static_cast<int>(steps.size()) <= level) steps.push_back(motion_.step(0.5 * steps.back().h));
        return steps[static_cast<Index>(level)];
    }
    bool escaped() const {
        return !(largest_u_ <= kMaxResponseRatio * sizes_.u && largest_y_ <= kMaxResponseRatio * sizes_.y);
    }
    void run_piece(Piece& piece, int level, double t, double t_end, double v, double u);
    void add_node(double t, const OutputMotion& now, double u);
    bool swings(Piece& piece, int level, std::vector<double> x, const ResponseNode& left, const OutputMotion& end,
                double v);
    void note(double t);

    const SampledPid law_;
    const StepInputs in_;
    const SampledCourse course_;
    Index next_jump_ = 0;
    const SampledOptions options_;
    const double end_;  // the horizon
    PidProgram program_;
    SampledDelay to_plant_, computed_, load_;
    SteadyState rest_;
    HeldMotion motion_;
    std::vector<Piece> pieces_;
    std::vector<double> x_;  // of the plant, and the integral of y
    std::vector<double> u_;
    double largest_y_ = 0, largest_u_ = 0;
    LoopSizes sizes_;
    double last_v_ = 0;
    double fastest_swing_ = 0;  // rad/time, the fastest of the plant's poles
    StoppingRule rule_;
    StepResponse response_;
};

SampledRun::SampledRun(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits,
                       const StepInputs& inputs, SampledCourse course, const SampledOptions& options)
    : law_(law),
      in_(inputs),
      course_(std::move(course)),
      options_(options),
      end_(options.horizon.value_or(std::numeric_limits<double>::infinity())),
      program_(law, limits),
      to_plant_(in_samples(plant.dead_time() + law.computation_delay, law.Ts)),
      computed_(in_samples(law.computation_delay, law.Ts)),
      load_(in_samples(plant.dead_time(), law.Ts)),
      rest_(course_.rest),
      motion_(course_.plant, 1, true),
      pieces_(pieces()),
      x_(static_cast<Index>(motion_.states()), 0.0),
      sizes_(loop_sizes(own_gain(plant, law.gains), law.gains, course_.largest)),
      rule_(options.settled, (to_plant_.whole + kRestSamples) * law.Ts) {
    for (const auto pole : plant.poles()) fastest_swing_ = std::max(fastest_swing_, pole.imag());
    sizes_.y = std::max(sizes_.y, std::abs(rest_.y));
    sizes_.u = std::max(sizes_.u, std::abs(rest_.u));
}

std::vector<Piece> SampledRun::pieces() const {
    std::vector<double> borders{0, to_plant_.rest, computed_.rest, in_.d != 0 ? load_.rest : 0, law_.Ts};
    std::sort(borders.begin(), borders.end());
    borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
    std::vector<Piece> made;
    for (Index i = 0; i + 1 < borders.size(); ++i)
        made.push_back(
            piece(borders[i], borders[i + 1] - borders[i], borders[i] >= to_plant_.rest, borders[i] >= computed_.rest));
    return made;
}

void SampledRun::add_node(double t, const OutputMotion& now, double u) {
    response_.nodes.push_back({t, now.y, now.slope, u, 0, in_.r * t - x_.back()});
    largest_y_ = std::max(largest_y_, std::abs(now.y));
    largest_u_ = std::max(largest_u_, std::abs(u));
}

// True if whole oscillations may lie between a piece's ends and its midpoint, where the check would not notice them.
bool SampledRun::swings(Piece& piece, int level, std::vector<double> x, const ResponseNode& left,
                        const OutputMotion& end, double v) {
    const double h = halved(piece.whole, level).h, s = kProbeShare, r = 1 - s;
    motion_.advance(halved(piece.probe, level), v, x);
    const double y = motion_.value(x, v);
    const double cubic =
        r * r * (1 + 2 * s) * left.y + s * s * (1 + 2 * r) * end.y + h * s * r * (r * left.y_slope - s * end.slope);
    return std::abs(cubic - y) > options_.tolerance * std::max(largest_y_, std::abs(y));
}

// A piece in which inputs that are states change.
void SampledRun::run_changing(Piece& piece, double t, double t_end, double v, double u) {
    while (changes_before(t_end)) {
        const StateJump& jump = course_.jumps[next_jump_++];
        if (jump.t > t + kInstantTolerance * law_.Ts) {
            Piece part = this->piece(piece.from, jump.t - t, piece.arrived, piece.given);
            run_piece(part, 0, t, jump.t, v, u);
            t = jump.t;
        }
        x_[static_cast<Index>(jump.state)] += jump.change;
        add_node(t, motion_.output(x_, v), u);
    }
    Piece last = this->piece(piece.from, t_end - t, piece.arrived, piece.given);
    run_piece(last, 0, t, t_end, v, u);
}

// Runs from the last node over 2^-level of the piece: a node at its end, and more inside if a cubic is not accurate
// enough.
void SampledRun::run_piece(Piece& piece, int level, double t, double t_end, double v, double u) {
    const ResponseNode left = response_.nodes.back();
    const std::vector<double> start = x_;
    const HeldStep& half = halved(piece.whole, level + 1);
    const double h = 2 * half.h;
    motion_.advance(half, v, x_);
    const double y_middle = motion_.value(x_, v);
    motion_.advance(half, v, x_);
    const OutputMotion end = motion_.output(x_, v);
    const double cubic = 0.5 * (left.y + end.y) + 0.125 * h * (left.y_slope - end.slope);
    const double scale = std::max(largest_y_, std::abs(y_middle));
    const bool bent = std::abs(cubic - y_middle) > options_.tolerance * scale ||
                      (h * fastest_swing_ > std::numbers::pi && swings(piece, level, start, left, end, v));
    if (bent && level < kMaxHalvings && response_.nodes.size() < kMaxNodes) {
        x_ = start;
        const double t_middle = 0.5 * (t + t_end);
        run_piece(piece, level + 1, t, t_middle, v, u);
        run_piece(piece, level + 1, t_middle, t_end, v, u);
        return;
    }
    add_node(t_end, end, u);
}

void SampledRun::run_period(int k) {
    for (Index i = 0; i < pieces_.size(); ++i) {
        Piece& piece = pieces_[i];
        // Exactly the same numbers as those with which the next piece, and the next period, begin.
        const double t = k * law_.Ts + piece.from;
        const double t_end = i + 1 < pieces_.size() ? k * law_.Ts + pieces_[i + 1].from : (k + 1) * law_.Ts;
        const bool loaded = k > load_.whole || (k == load_.whole && piece.from >= load_.rest);
        const double v = input(k, piece.arrived) + (loaded ? in_.d : 0), u = output(k, piece.given);
        const bool jumps = v != last_v_ || response_.nodes.empty() || u != response_.nodes.back().u;
        if (jumps) add_node(t, motion_.output(x_, v), u);
        last_v_ = v;
        if (changes_before(std::min(t_end, end_))) {
            run_changing(piece, t, std::min(t_end, end_), v, u);
            if (ends_by(t_end)) return;
            continue;
        }
        if (ends_by(t_end)) {
            if (t_end == end_) return run_piece(piece, 0, t, end_, v, u);
            Piece last = this->piece(piece.from, end_ - t, piece.arrived, piece.given);
            return run_piece(last, 0, t, end_, v, u);
        }
        run_piece(piece, 0, t, t_end, v, u);
    }
}

void SampledRun::sample(int k) {
    // Read just before anything changes at t_k: an input that arrives at that very time is not included.
    const double v = input(k, false) + (k > load_.whole ? in_.d : 0);
    u_.push_back(program_.step(setpoint(k * law_.Ts), motion_.value(x_, v)));
}

void SampledRun::note(double t) {
    const ResponseNode& node = response_.nodes.back();
    rule_.note(t, std::abs(node.y - rest_.y), std::max(largest_y_, std::abs(rest_.y)), std::abs(u_.back() - rest_.u),
               std::max(largest_u_, std::abs(rest_.u)));
}

StepResponse SampledRun::result() {
    response_.settles = false;
    // Takes at least one period, so that a response that is stopped at once has a first point.
    for (int k = 0; k < options_.max_samples && (k == 0 || !options_.stop.stop_requested()); ++k) {
        sample(k);
        run_period(k);
        const double t = (k + 1) * law_.Ts;
        if (k < 2) sizes_.u = std::max(sizes_.u, largest_u_);
        if (escaped()) break;
        note(t);
        if (t < course_.last_change) rule_.start_again(t);
        response_.settles =
            options_.horizon ? ends_by(t) : rest_.exists && t > course_.last_change && rule_.has_settled(t);
        if (response_.settles) break;
    }
    response_.y_final = rest_.y;
    response_.u_final = rest_.u;
    if (response_.settles && law_.gains.Ki != 0 && !rest_.at_limit)
        response_.error_integral_final = response_.nodes.back().error_integral;
    return std::move(response_);
}

}  // namespace

StepResponse simulate_sampled(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits,
                              const StepInputs& inputs, const SampledOptions& options) {
    SteadyState rest = rest_of(plant, law.gains, inputs);
    if (limits.output) rest = within_limits(rest, plant, *limits.output, inputs.d);
    return SampledRun(plant, law, limits, inputs,
                      {.plant = plant.realisation(), .jumps = {}, .setpoint = {}, .rest = rest, .largest = inputs},
                      options)
        .result();
}

StepResponse simulate_sampled_course(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits,
                                     const SampledCourse& course, const SampledOptions& options) {
    return SampledRun(plant, law, limits, {}, course, options).result();
}

namespace {

constexpr double kTolerance = 1e-8;       // of the steps of the integration
constexpr double kBend = 1e-9;            // of the largest |y|: the change of y over a step by a jump of its slope
constexpr double kTimeTolerance = 1e-12;  // relative: closer times are equal
constexpr int kMinRestSamples = 3;        // the least time that a response must have rested, in addition to its dead
                                          // time

struct Given {
    double t = 0, u = 0;
};

class NonlinearRun {
public:
    NonlinearRun(const NonlinearSystem& system, const SampledPid& law, const ProgramLimits& limits,
                 const StepInputs& inputs, const SampledOptions& options)
        : law_(law),
          in_(inputs),
          options_(options),
          output_(limits.output),
          program_(law, limits),
          plant_(system, kTolerance),
          recorder_(response_, recording_, inputs.r),
          rule_(options.settled, system.dead_time() + law.computation_delay + kMinRestSamples * law.Ts),
          min_size_u_(loop_sizes(size_of_effect(system, 1), law.gains, inputs).u) {}

    StepResponse result();

private:
    bool run_to(double t);
    bool advance(double t);
    bool slope_jumped(const StepPolynomial& y) const;
    bool at_limit() const { return output_ && (u_ <= output_->min || u_ >= output_->max); }
    void note(double t);

    const SampledPid law_;
    const StepInputs in_;
    const SampledOptions options_;
    const std::optional<ActuatorLimits> output_;
    PidProgram program_;
    PlantRun plant_;
    NonlinearResponse response_;
    NonlinearOptions recording_;
    ResponseRecorder recorder_;
    StoppingRule rule_;
    std::deque<Given> outputs_;         // computed, but not yet effective
    double u_ = 0;                      // given out
    double y_quiet_ = 0, u_quiet_ = 0;  // y and u have stayed near these values since they last moved
    double size_y_ = 0, size_u_ = 0;
    double min_size_u_;  // of the loop, independent of the first samples
};

// True if the input that arrives after the dead time changes the slope of y at once: the plant's relative degree is
// one.
bool NonlinearRun::slope_jumped(const StepPolynomial& y) const {
    const auto& nodes = response_.loop.nodes;
    return !nodes.empty() && std::abs(y.slope(0) - nodes.back().y_slope) * y.h > kBend * size_y_;
}

bool NonlinearRun::advance(double t) {
    const double short_of = kTimeTolerance * std::max(t, law_.Ts);
    while (plant_.t() < t - short_of) {
        if (!plant_.step(t)) return false;
        const StepPolynomial& y = plant_.last();
        if (slope_jumped(y)) recorder_.border();
        recorder_.add(y, StepPolynomial::constant(y.t, y.h, u_));
    }
    return true;
}

bool NonlinearRun::run_to(double t) {
    while (!outputs_.empty() && outputs_.front().t < t) {
        const Given next = outputs_.front();
        outputs_.pop_front();
        if (!advance(next.t)) return false;
        if (next.u != u_) recorder_.border();
        u_ = next.u;
        plant_.give(u_ + in_.d);
    }
    return advance(t);
}

// With integral action y comes to rest at r; without it, or at a limit, wherever it stays.
void NonlinearRun::note(double t) {
    const double y = plant_.y();
    size_y_ = std::max({size_y_, std::abs(y), std::abs(in_.r)});
    size_u_ = std::max({size_u_, std::abs(u_), std::abs(in_.d)});
    const double moved = std::abs(y - y_quiet_), moved_u = std::abs(u_ - u_quiet_);
    const bool to_r = law_.gains.Ki != 0 && !at_limit();
    rule_.note(t, to_r ? std::abs(y - in_.r) : moved, size_y_, moved_u, size_u_);
    if (moved > options_.settled * size_y_ || moved_u > options_.settled * size_u_) {
        y_quiet_ = y;
        u_quiet_ = u_;
    }
}

StepResponse NonlinearRun::result() {
    StepResponse& loop = response_.loop;
    loop.settles = false;
    if (in_.d != 0) plant_.give(in_.d);
    for (int k = 0; k < options_.max_samples && !options_.stop.stop_requested(); ++k) {
        double t = (k + 1) * law_.Ts;
        if (options_.horizon && t >= *options_.horizon - kTimeTolerance * t) t = *options_.horizon;
        outputs_.push_back({k * law_.Ts + law_.computation_delay, program_.step(in_.r, plant_.y())});
        if (!run_to(t)) break;
        note(t);
        if (k < kMinRestSamples) min_size_u_ = std::max(min_size_u_, size_u_);
        if (!(size_u_ <= kMaxResponseRatio * min_size_u_)) break;
        loop.settles = options_.horizon ? t >= *options_.horizon : rule_.has_settled(t);
        if (loop.settles) break;
    }
    const bool at_r = law_.gains.Ki != 0 && loop.settles && !at_limit();
    loop.y_final = at_r ? in_.r : plant_.y();
    loop.u_final = u_;
    if (loop.nodes.empty()) loop.nodes.push_back({});
    if (at_r) loop.error_integral_final = loop.nodes.back().error_integral;
    return std::move(loop);
}

}  // namespace

StepResponse simulate_sampled(const NonlinearSystem& system, const SampledPid& law, const ProgramLimits& limits,
                              const StepInputs& inputs, const SampledOptions& options) {
    return NonlinearRun(system, law, limits, inputs, options).result();
}

}  // namespace tunewright
