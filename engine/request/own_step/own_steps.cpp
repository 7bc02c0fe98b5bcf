#include "engine/request/own_step/own_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "engine/evaluation/evaluate_sampled.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/simulation/course/course.h"
#include "engine/simulation/linear/indices.h"

namespace tunewright {
namespace {

using Nodes = std::vector<ResponseNode>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRestBand = 0.01;        // of the largest deviation: y counts as at rest for plots and the hold
constexpr double kSpaceAfterRest = 1.25;  // multiple of the time to that rest
constexpr double kMaxOverShortest = 3;    // quick loops would be a line at the left edge
constexpr double kUnsettledTimes = 10;    // multiple of the plant's own time: the hold if no loop settles
constexpr double kRestTolerance = 1e-6;   // of the step or load's effect: y rests at the target
constexpr double kLimitTolerance = 1e-9;  // of u's range: u is at its limit
constexpr double kSettled = 1e-7;         // of the largest deviation, where a run ends
constexpr double kTolerance = 1e-6;       // of the interpolation
constexpr int kMaxSteps = 30000;
constexpr int kMaxSamples = 200000;
constexpr const char* kStays = "u stays at its limit.";
constexpr const char* kNeverThere =
    "y does not come to rest at the target, so the integral of the error is infinite. Give a length.";
constexpr const char* kTooShort = "The simulated time ends before the load.";
constexpr const char* kCut =
    "The simulation ended early: y grows without bound, or this time has too many samples. Shorten the hold or give a "
    "length.";
constexpr double kQuietShare = 0.1;  // of a given time: y rests if it has stayed in kRestBand for so long at its end

/// One loop, ready to run any course.
struct RunningLoop {
    TuningEntry* entry = nullptr;
    std::variant<ParallelPid, SampledPid> law;
    ProgramLimits program;
    StepResponse response;
    bool to_rest = true;  ///< it was run until it rests, not for a given time
    bool whole = true;    ///< it was run to its end

    double last() const { return response.nodes.back().t; }
    double resolution() const { return std::holds_alternative<SampledPid>(law) ? program.u_resolution : 0; }
};

/// The later of two groups of times that does not leave the shortest far behind.
double common(const std::vector<double>& times) {
    if (times.empty()) return 0;
    const auto [shortest, longest] = std::ranges::minmax(times);
    return std::min(longest, kMaxOverShortest * shortest);
}

/// The nodes from `from` to `to`, with the time counted from `from`; at a jump only the side within.
Nodes part(const Nodes& nodes, double from, double to) {
    const double slack = 1e-12 * std::max(1.0, std::abs(to < kInfinity ? to : from));
    Nodes out;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const ResponseNode& node = nodes[i];
        if (node.t < from - slack || node.t > to + slack) continue;
        const bool after_first = i + 1 < nodes.size() && nodes[i + 1].t <= from + slack;
        if (from > 0 && after_first) continue;
        out.push_back(node);
        out.back().t -= from;
        if (node.t >= to - slack) break;
    }
    return out;
}

class OwnStepRuns {
public:
    OwnStepRuns(const LinearPlant& plant, const OwnStep& step, int points, std::stop_token stop)
        : plant_(plant), step_(step), points_(points), stop_(std::move(stop)) {
        course_.r = step_.target - step_.y;
        if (step_.ramp_rate) course_.ramp_time = std::abs(course_.r) / *step_.ramp_rate;
        limits_ = {step_.u_min ? *step_.u_min - step_.u : -kInfinity, step_.u_max ? *step_.u_max - step_.u : kInfinity};
    }

    bool limited() const { return step_.u_min || step_.u_max; }
    const ActuatorLimits& limits() const { return limits_; }
    bool needs_hold() const { return step_.load && !step_.hold && course_.r != 0; }

    /// The time after the ramp that this loop needs to come to rest without the load; empty: it does not settle.
    std::optional<double> hold_of(const RunningLoop& loop) const {
        const StepResponse response = run(loop, unrounded(loop), course_, {});
        if (!response.settles) return std::nullopt;
        return std::max(0.0, two_digits_up(kSpaceAfterRest * quiet_after(response, 0)) - course_.ramp_time);
    }
    double unsettled_hold() const { return kUnsettledTimes * std::max(plant_.time_scale(), course_.ramp_time); }

    void run_with_load(std::vector<RunningLoop>& loops, double hold, const RunControl& control) {
        if (step_.load) {
            const OwnStep::Load& load = *step_.load;
            course_.load = CourseLoad{load.size, load.at_output, load.shape, load.duration.value_or(0),
                                      course_.ramp_time + step_.hold.value_or(hold)};
        }
        parallel_for(control.spread, static_cast<int>(loops.size()), [&](int i) {
            RunningLoop& loop = loops[static_cast<std::size_t>(i)];
            run_whole(loop);
            loop.entry->own_step = figures(loop);
        });
        if (points_ >= 2) draw(loops);
    }

private:
    static ProgramLimits unrounded(const RunningLoop& loop) { return {loop.program.output, 0, 0, 0}; }

    /// A loop that rounding keeps moving is run for as long as it would need without.
    void run_whole(RunningLoop& loop) const {
        std::optional<double> horizon = step_.length;
        loop.whole = true;
        if (!horizon && std::holds_alternative<SampledPid>(loop.law) && !comes_to_rest(loop.program)) {
            const StepResponse without = run(loop, unrounded(loop), course_, {});
            horizon = without.nodes.back().t;
            loop.whole = without.settles;
        }
        loop.to_rest = !horizon;
        loop.response = run(loop, loop.program, course_, horizon);
        loop.whole = loop.whole && loop.response.settles;
    }

    StepResponse run(const RunningLoop& loop, const ProgramLimits& program, const Course& course,
                     std::optional<double> horizon) const {
        if (const auto* law = std::get_if<SampledPid>(&loop.law))
            return simulate_course(plant_, *law, program, course,
                                   {.tolerance = kTolerance,
                                    .settled = kSettled,
                                    .horizon = horizon,
                                    .max_samples = kMaxSamples,
                                    .stop = stop_});
        ResponseOptions options;
        options.tolerance = kTolerance;
        options.settled = kSettled;
        options.horizon = horizon;
        options.max_steps = kMaxSteps;
        return simulate_course(plant_, std::get<ParallelPid>(loop.law), course, limits_, options);
    }

    double load_start() const { return course_.load ? course_.load->start : 0; }

    /// The last time at which y is outside `kRestBand` of its largest deviation after `from`.
    double quiet_after(const StepResponse& response, double from) const {
        const Nodes nodes = part(response.nodes, from, kInfinity);
        double largest = 0;
        for (const auto& node : nodes) largest = std::max(largest, std::abs(node.y - response.y_final));
        const auto last = last_outside(nodes, response.y_final, kRestBand * largest);
        return from + last.value_or(response.nodes.back().t - from);
    }

    /// The nodes with y relative to a reference of constant rate, whose value at the first node is `start`, and the
    /// integral of the error from there on: that of the nodes is the integral of -y.
    static Nodes relative(Nodes nodes, double start, double rate) {
        if (nodes.empty()) return nodes;
        const double first = nodes.front().error_integral;
        for (ResponseNode& node : nodes) {
            node.error_integral += (start + 0.5 * rate * node.t) * node.t - first;
            node.y -= start + rate * node.t;
            node.y_slope -= rate;
        }
        return nodes;
    }

    /// The integral of |r - y| from `from` to `to`, the ramp and the time after it apart, because r has a kink.
    double IAE(const Nodes& nodes, double from, double to) const {
        const double end = std::clamp(course_.ramp_time, from, to);
        double sum = 0;
        for (const Nodes& piece :
             {end > from ? relative(part(nodes, from, end), setpoint_at(course_, from), course_.r / course_.ramp_time)
                         : Nodes{},
              relative(part(nodes, end, to), course_.r, 0)})
            if (piece.size() > 1) sum += error_integrals(piece, 0, std::nullopt).IAE;
        return sum;
    }

    bool rests(const RunningLoop& loop) const {
        return loop.whole && (loop.to_rest || quiet_after(loop.response, 0) <= (1 - kQuietShare) * loop.last());
    }

    bool rests_at_target(const RunningLoop& loop) const {
        double size = std::abs(course_.r);
        for (const auto& node : loop.response.nodes) size = std::max(size, std::abs(node.y));
        return rests(loop) && std::abs(loop.response.y_final - course_.r) <= kRestTolerance * size;
    }

    /// The reason for having no integral of the error up to the end; null: there is one.
    const char* no_integral(const RunningLoop& loop) const {
        if (!loop.whole) return loop.to_rest && loop.response.nodes.back().t > load_start() ? kNeverThere : kCut;
        return loop.to_rest && !rests_at_target(loop) ? kNeverThere : nullptr;
    }

    OwnSetpointFigures setpoint_figures_of(const RunningLoop& loop) const {
        const double end = course_.load ? load_start() : kInfinity, r = course_.r;
        const Nodes nodes = part(loop.response.nodes, 0, end);
        OwnSetpointFigures out;
        const char* why = course_.load ? (loop.last() < end && !loop.whole ? kCut : nullptr) : no_integral(loop);
        out.IAE = why == nullptr ? Figure(IAE(loop.response.nodes, 0, end)) : no_figure(why);
        const Extremes extremes = extremes_of_y(nodes);
        const double beyond = std::max(0.0, r > 0 ? extremes.max - r : r - extremes.min);
        out.overshoot = beyond > kRestTolerance * std::abs(r) ? beyond : 0;
        out.overshoot_percent = 100 * *out.overshoot / std::abs(r);
        out.settling_time = Figure(last_outside(nodes, r, kSettlingBand * std::abs(r)),
                                   course_.load ? "y is not within 2 % of the step when the load comes."
                                                : "y does not stay within 2 % of the step.");
        return out;
    }

    OwnLoadFigures load_figures_of(const RunningLoop& loop) const {
        OwnLoadFigures out;
        out.start = load_start();
        const bool too_short = step_.length && out.start >= *step_.length;
        if (too_short || (!loop.whole && loop.last() <= out.start)) {
            out.IAE = out.peak = out.recovery_time = no_figure(too_short ? kTooShort : kCut);
            return out;
        }
        Nodes nodes = part(loop.response.nodes, out.start, kInfinity);
        for (auto& node : nodes) node.y -= course_.r;
        const char* why = no_integral(loop);
        out.IAE = why == nullptr ? Figure(IAE(loop.response.nodes, out.start, kInfinity)) : no_figure(why);
        const Extremes extremes = extremes_of_y(nodes);
        out.peak = std::abs(extremes.max) >= std::abs(extremes.min) ? extremes.max : extremes.min;
        out.recovery_time = Figure(last_outside(nodes, 0, kSettlingBand * std::abs(*out.peak)),
                                   "y does not return to within 2 % of the peak.");
        return out;
    }

    /// The time that u spends at `limit`; infinite where it stays there.
    Figure time_at(const RunningLoop& loop, double limit) const {
        const StepResponse& response = loop.response;
        if (!std::isfinite(limit)) return 0.0;
        const double range = std::isfinite(limits_.max - limits_.min) ? limits_.max - limits_.min : std::abs(limit),
                     band = std::max(kLimitTolerance * range, loop.resolution());
        const auto at = [&](const ResponseNode& node) {
            return limit == limits_.max ? node.u >= limit - band : node.u <= limit + band;
        };
        if (loop.to_rest && loop.whole && at({.u = response.u_final}) && at(response.nodes.back()))
            return no_figure(kStays);
        double time = 0;
        for (std::size_t i = 1; i < response.nodes.size(); ++i)
            if (at(response.nodes[i - 1]) && at(response.nodes[i]))
                time += response.nodes[i].t - response.nodes[i - 1].t;
        return time;
    }

    /// u for which the plant rests at the target, after the load.
    Figure u_needed() const {
        const bool stays = step_.load && step_.load->shape != LoadShape::pulse;
        const double d = stays && !step_.load->at_output ? step_.load->size : 0,
                     q = stays && step_.load->at_output ? step_.load->size : 0;
        if (plant_.integrators() > 0) return step_.u - d;
        const double K = plant_.integrators() < 0 ? 0 : plant_.low_frequency_gain();
        if (K == 0) return no_figure("No constant u changes y of this plant.");
        return step_.u + (course_.r - q) / K - d;
    }

    OwnStepEntry figures(const RunningLoop& loop) const {
        const StepResponse& response = loop.response;
        OwnStepEntry out;
        if (course_.r != 0) out.setpoint = setpoint_figures_of(loop);
        if (course_.load) out.load = load_figures_of(loop);
        Nodes of_u = response.nodes;
        for (auto& node : of_u) {
            node.y = node.u;
            node.y_slope = node.u_slope;
        }
        const Extremes u = extremes_of_y(of_u);
        out.u_min = step_.u + std::clamp(u.min, limits_.min, limits_.max);
        out.u_max = step_.u + std::clamp(u.max, limits_.min, limits_.max);
        out.travel = total_variation(response.nodes);
        out.time_at_min = time_at(loop, limits_.min);
        out.time_at_max = time_at(loop, limits_.max);
        out.u_needed = u_needed();
        out.settles = rests(loop);
        out.y_final = out.settles ? Figure(step_.y + response.y_final)
                                  : no_figure("The loop does not rest within the simulated time.");
        return out;
    }

    void draw(std::vector<RunningLoop>& loops) const {
        std::vector<double> ends;
        for (const RunningLoop& loop : loops)
            if (loop.whole) ends.push_back(kSpaceAfterRest * (quiet_after(loop.response, load_start()) - load_start()));
        const double start = load_start();
        for (RunningLoop& loop : loops) {
            const double last = loop.response.nodes.back().t;
            const double wanted = step_.length   ? *step_.length
                                  : ends.empty() ? last
                                                 : two_digits_up(start + std::max(common(ends), shortest_end()));
            loop.entry->own_step->trace =
                trace(loop.response, loop.whole && loop.to_rest ? wanted : std::min(wanted, last));
        }
    }
    /// So much of the plot comes after the load or the step at least.
    double shortest_end() const { return 0.25 * load_start(); }

    OwnStepTrace trace(const StepResponse& response, double horizon) const {
        const Trace deviations = trace_of(response, horizon, points_);
        OwnStepTrace out{deviations.t, {}, deviations.y, deviations.u};
        for (double& y : out.y) y += step_.y;
        for (double& u : out.u) u += step_.u;
        for (const double t : out.t) out.r.push_back(step_.y + setpoint_at(course_, t));
        return out;
    }

    const LinearPlant& plant_;
    const OwnStep step_;
    const int points_;
    const std::stop_token stop_;
    Course course_;
    ActuatorLimits limits_;
};

/// The law of the loop that runs, or the reason why it cannot.
std::variant<std::variant<ParallelPid, SampledPid>, OwnStepRefusal> law_of(const TuningEntry& entry,
                                                                           const device::DeviceModel* device,
                                                                           const OwnStep& step) {
    if (std::holds_alternative<Npid>(entry.evaluation->controller)) return OwnStepRefusal::no_law;
    const bool built = entry.on_device && device != nullptr;
    if (!entry.evaluation->robustness.stable || (entry.on_device && !entry.on_device->loop.robustness.stable))
        return OwnStepRefusal::unstable;
    if (built && device->sampled()) return std::variant<ParallelPid, SampledPid>(entry.on_device->fitted.law);
    const ParallelPid law = gains(entry.on_device ? Controller(device::continuous(entry.on_device->fitted.controller))
                                                  : entry.evaluation->controller);
    const bool jumps = step.load && step.load->at_output && step.load->shape != LoadShape::ramp;
    if (jumps && law.Kd != 0 && law.filter.type == FilterType::none) return OwnStepRefusal::impulse;
    return std::variant<ParallelPid, SampledPid>(law);
}

}  // namespace

bool simulate_own_steps(std::vector<TuningEntry>& entries, const AnalysedPlant& subject,
                        const std::optional<OwnStep>& step, int points,
                        const std::function<const device::DeviceModel*(const TuningEntry&)>& device_of,
                        const RunControl& control) {
    if (!step) return true;
    const LinearPlant* plant = subject.linear();
    std::optional<OwnStepRuns> runs;
    if (plant != nullptr) runs.emplace(*plant, *step, points, control.stop);
    std::vector<RunningLoop> loops;
    for (TuningEntry& entry : entries) {
        if (!entry.evaluation) continue;
        OwnStepEntry& own = entry.own_step.emplace();
        if (plant == nullptr || subject.equations() != nullptr) {
            own.refused = plant == nullptr ? OwnStepRefusal::no_time : OwnStepRefusal::equations;
            continue;
        }
        const device::DeviceModel* device = device_of(entry);
        auto law = law_of(entry, device, *step);
        if (const auto* refusal = std::get_if<OwnStepRefusal>(&law)) {
            own.refused = *refusal;
            continue;
        }
        RunningLoop loop{&entry, std::get<0>(std::move(law)), {}, {}};
        if (device != nullptr) loop.program = device->program;
        if (runs->limited()) loop.program.output = runs->limits();
        loops.push_back(std::move(loop));
    }
    if (loops.empty()) return true;
    double hold = 0;
    if (runs->needs_hold()) {
        std::vector<double> holds;
        for (const RunningLoop& loop : loops)
            if (const auto needed = runs->hold_of(loop)) holds.push_back(*needed);
        hold = holds.empty() ? runs->unsettled_hold() : common(holds);
    }
    runs->run_with_load(loops, hold, control);
    if (!control.stop.stop_requested()) return true;
    // A run that was stopped has figures of a shorter time.
    for (TuningEntry& entry : entries) entry.own_step.reset();
    return false;
}

}  // namespace tunewright
