#include "engine/verify/second_figures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/blocks/diagram_response.h"
#include "engine/blocks/diagram_stability.h"
#include "engine/evaluation/performance_figures.h"
#include "engine/loop/loop.h"
#include "engine/loop/noise.h"
#include "engine/verify/piecewise_cubic.h"
#include "engine/verify/single_loop.h"

namespace tunewright::verify {
namespace {

constexpr double kTolerance = 1e-10, kSettled = 1e-10;  // of the runs
constexpr double kAtRest = 1e-6;  // of the largest y: an error that is larger at the end does not go to 0
constexpr double kMaxTail =
    0.2;  // time constant of the rest, of the run's length: a longer one is rounding over rounding
constexpr int kMaxSteps = 200'000;

struct Curves {
    PiecewiseCubic y, u;
    bool settles = true;
};

Curves curves_of(const DiagramResponse& response, int y, int u, double r) {
    const StepResponse nodes = response.pair(y, u, r);
    std::vector<double> t;
    std::vector<Signal> of_y, of_u;
    for (const ResponseNode& node : nodes.nodes) {
        t.push_back(node.t);
        of_y.push_back({node.y, node.y_slope});
        of_u.push_back({node.u, node.u_slope});
    }
    return {{t, of_y}, {t, of_u}, response.settles()};
}

/// The closed form of the integral of r - y to infinity; empty without integral action. With
/// u(inf) = r/P(0) - d = Kp (b - 1) r + Ki int (r_f - y_f), whose lags take T r and Tf r away.
std::optional<double> integral_of_error(const LinearPlant& plant, const ParallelPid& pid, double r, double d) {
    if (pid.Ki == 0) return std::nullopt;
    if (plant.integrators() < 0) return std::nullopt;
    const double rest = plant.integrators() > 0 ? 0 : r / plant.low_frequency_gain();
    const bool filtered = pid.filter.type == FilterType::measurement_first_order ||
                          pid.filter.type == FilterType::measurement_second_order;
    return (rest - d - pid.Kp * (pid.b - 1) * r) / pid.Ki + (pid.setpoint_lag - (filtered ? pid.filter.Tf : 0)) * r;
}

/// IAE, ISE and ITAE to infinity: what remains after the last node keeps its sign and is one exponential.
template <class Figures>
void store_integrals(Figures& p, const Curves& curves, double target, bool to_infinity,
                     const std::optional<double>& all) {
    PiecewiseCubic::ErrorIntegrals sums = curves.y.integrals(target);
    const double e = target - curves.y.last(), size = std::max({std::abs(target), curves.y.max(), -curves.y.min()});
    if (to_infinity && (!curves.settles || std::abs(e) > kAtRest * size)) {
        p.IAE = p.ISE = p.ITAE = no_figure("By the second method the error does not go to 0.");
        return;
    }
    if (to_infinity && all) {
        const double rest = *all - sums.error;
        const double time_constant = e != 0 ? rest / e : 0;
        if (time_constant > 0 && time_constant < kMaxTail * curves.y.end()) {
            sums.absolute += std::abs(rest);
            sums.square += 0.5 * rest * e;
            sums.time_absolute += std::abs(rest) * (curves.y.end() + time_constant);
        }
    }
    p.IAE = sums.absolute;
    p.ISE = sums.square;
    p.ITAE = sums.time_absolute;
}

SetpointPerformance of_setpoint(const Curves& curves, double step, bool to_infinity, const std::optional<double>& all,
                                double first_move) {
    SetpointPerformance p;
    store_integrals(p, curves, step, to_infinity, all);
    const double furthest = step > 0 ? curves.y.max() : curves.y.min();
    p.overshoot_percent = std::max(0.0, 100 * (furthest / step - 1));
    const auto rise = [&](double from, double to) {
        const auto a = curves.y.first_reached(from * step), b = curves.y.first_reached(to * step);
        return a && b ? Figure(*b - *a) : no_figure("By the second method the response does not reach that level.");
    };
    p.rise_time = rise(0.1, 0.9);
    p.rise_time_5_95 = rise(0.05, 0.95);
    p.settling_time = Figure(curves.y.last_outside(step, kSettlingBand * std::abs(step)),
                             "By the second method the response does not settle.");
    p.TV = curves.u.variation();
    p.first_move = first_move;
    return p;
}

LoadPerformance of_load(const Curves& curves, bool to_infinity, const std::optional<double>& all) {
    LoadPerformance p;
    store_integrals(p, curves, 0, to_infinity, all);
    const double max = curves.y.max(), min = curves.y.min();
    p.peak = max >= -min ? max : min;
    p.recovery_time = Figure(curves.y.last_outside(0, kSettlingBand * std::abs(*p.peak)),
                             "By the second method the response does not return.");
    p.TV = curves.u.variation();
    return p;
}

/// sigma_u/sigma_n of held white noise: the root of the integral of p(t)^2/Ts, p the response of u to one held sample.
std::optional<double> noise_gain_over_time(const SingleLoop& loop, double Ts) {
    const auto response = DiagramResponse::of(loop.diagram, {{loop.seen, 1}},
                                              {.tolerance = kTolerance, .settled = kSettled, .max_steps = kMaxSteps});
    if (!response || !response->settles()) return std::nullopt;
    std::vector<double> ends;
    for (const ResponseNode& node : response->pair(loop.y, loop.u, 0).nodes) {
        ends.push_back(node.t);
        ends.push_back(node.t + Ts);
    }
    std::ranges::sort(ends);
    const double half_gap = 0.5 / std::sqrt(3.0);  // Gauss and Legendre's rule of two points, in four parts
    std::vector<double> now, before, weights;
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const double part = (ends[i] - ends[i - 1]) / 4;
        if (!(part > 0)) continue;
        for (int k = 0; k < 4; ++k)
            for (const double side : {-half_gap, half_gap}) {
                const double t = ends[i - 1] + part * (k + 0.5 + side);
                now.push_back(t);
                before.push_back(std::max(0.0, t - Ts));
                weights.push_back(part / 2);
            }
    }
    const auto g = response->sampled(loop.u, now), past = response->sampled(loop.u, before);
    double sum = 0;
    for (std::size_t i = 0; i < g.size(); ++i) {
        const double p = g[i] - (now[i] > Ts ? past[i] : 0);
        sum += weights[i] * p * p;
    }
    return std::sqrt(sum / Ts);
}

/// A response of the loop, or the reason why it has no second way.
Expected<Curves> respond(const SingleLoop& loop, const DiagramStep& step, double r, const EvaluateOptions& options) {
    const auto response = DiagramResponse::of(
        loop.diagram, {step},
        {.tolerance = kTolerance, .settled = kSettled, .horizon = options.horizon, .max_steps = kMaxSteps});
    if (!response) return response.error();
    Curves curves = curves_of(*response, loop.y, loop.u, r);
    if (!options.horizon && !curves.settles)
        return Error{ErrorKind::unsupported, "", "The second method's run does not come to rest within its steps."};
    if (options.actuator && (curves.u.max() > options.actuator->max || curves.u.min() < options.actuator->min))
        return Error{ErrorKind::unsupported, "",
                     "u reaches a limit of the actuator, and the second method has no limits."};
    return curves;
}

void add_performance(SecondFigures& second, const SingleLoop& loop, const LinearPlant& plant, const ParallelPid& pid,
                     const EvaluateOptions& o) {
    const bool to_infinity = !o.horizon.has_value();
    const auto setpoint = respond(loop, {loop.r, o.setpoint_step}, o.setpoint_step, o);
    if (setpoint) {
        const bool direct = pid.setpoint_lag == 0;
        const double derivative = pid.filter.type == FilterType::derivative ? pid.c * pid.Kd / pid.filter.Tf : 0;
        double first = direct ? pid.Kp * pid.b + derivative : 0;
        if (!direct && pid.filter.type != FilterType::derivative) first = pid.c * pid.Kd / pid.setpoint_lag;
        // A plant with a direct term and no dead time answers at once.
        const double through = plant.dead_time() > 0 ? 0 : plant.direct_term();
        if (through != 0) first = setpoint->u.at_start() / o.setpoint_step;
        second.performance.setpoint =
            of_setpoint(*setpoint, o.setpoint_step, to_infinity, integral_of_error(plant, pid, o.setpoint_step, 0),
                        first * o.setpoint_step);
    } else {
        second.unverified.push_back({"performance/setpoint", setpoint.error().message});
    }
    const auto load = respond(loop, {loop.u, o.load_step}, 0, o);
    if (load)
        second.performance.load = of_load(*load, to_infinity, integral_of_error(plant, pid, 0, o.load_step));
    else
        second.unverified.push_back({"performance/load", load.error().message});
    if (!o.noise) return;
    const bool infinite = pid.Kd != 0 && pid.filter.type == FilterType::none;
    const auto usual = Loop::make(plant, pid);
    double Ts = o.noise->sample_time;
    if (!(Ts > 0) && usual) Ts = default_noise_sample_time(*usual);
    const auto gain = infinite || !(Ts > 0) ? std::nullopt : noise_gain_over_time(loop, Ts);
    if (gain)
        second.performance.noise = NoisePerformance{*gain * o.noise->std, *gain};
    else
        second.unverified.push_back(
            {"performance/noise",
             "The second method needs a filter of the derivative and a response of u to noise that settles."});
}

}  // namespace

bool SecondFigures::lacks(const std::string& part) const {
    return std::ranges::any_of(
        unverified, [&](const Unverified& one) { return part == one.part || part.starts_with(one.part + "/"); });
}

SecondFigures second_figures(const LinearPlant& plant, const ParallelPid& pid, const EvaluateOptions& options,
                             const GivenPeaks& given) {
    SecondFigures second;
    const auto loop = single_loop(plant, pid);
    if (!loop) {
        second.unverified = {{"robustness", loop.error().message}, {"performance", loop.error().message}};
        return second;
    }
    const bool stable = count_unstable_poles(loop->diagram).stable();
    if (!loop->has_hidden_poles) {
        const auto pole = rightmost_pole(loop->diagram);
        if (pole && (pole->real() < 0) != stable) {
            const std::string why = "The second method's two tests of stability disagree.";
            second.unverified = {{"robustness", why}, {"performance", why}};
            return second;
        }
    }
    second.robustness.stable = stable;
    if (!stable) return second;
    if (auto scanned = scan_frequencies(plant, pid, given))
        second.robustness = *scanned;
    else
        second.unverified.push_back({"robustness", scanned.error().message});
    add_performance(second, *loop, plant, pid, options);
    return second;
}

}  // namespace tunewright::verify
