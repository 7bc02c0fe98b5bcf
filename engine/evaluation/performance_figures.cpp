#include "engine/evaluation/performance_figures.h"

#include <algorithm>
#include <cmath>

#include "engine/loop/noise.h"
#include "engine/simulation/linear/indices.h"

namespace tunewright {
namespace {

constexpr double kMaxRelativeRestError = 1e-9;  // of the largest y: a smaller error at rest counts as 0

/// The indices of one kind of performance, or the reason for their absence. `cut`: the run ended before its horizon.
template <class Figures>
void store(Figures& p, const Indices& indices, bool cut) {
    p.TV = cut ? no_figure(indices.why_no_error) : Figure(indices.TV);
    if (!indices.error) {
        p.IAE = p.ISE = p.ITAE = no_figure(indices.why_no_error);
        return;
    }
    p.IAE = indices.error->IAE;
    p.ISE = indices.error->ISE;
    p.ITAE = indices.error->ITAE;
}

}  // namespace

// The value at which the error comes to rest decides.
const char* why_no_integral(const StepResponse& response, double target, bool to_infinity) {
    if (!response.settles)
        return to_infinity ? "The response does not settle within the allowed number of steps; give a horizon."
                           : "The response needs more than the allowed number of steps; give a shorter horizon.";
    if (!to_infinity) return nullptr;
    double scale = std::abs(target);
    for (const auto& node : response.nodes) scale = std::max(scale, std::abs(node.y));
    if (std::abs(target - response.y_final) > kMaxRelativeRestError * scale)
        return "The error does not go to 0 (no integral action, or u stays at its limit), so its integral is infinite; "
               "give a "
               "horizon.";
    return nullptr;
}

Performance no_performance(const std::string& reason) {
    Performance performance;
    SetpointPerformance& r = performance.setpoint;
    for (Figure* figure : {&r.IAE, &r.ISE, &r.ITAE, &r.overshoot_percent, &r.rise_time, &r.rise_time_5_95,
                           &r.settling_time, &r.TV, &r.first_move})
        figure->why = reason;
    LoadPerformance& d = performance.load;
    for (Figure* figure : {&d.IAE, &d.ISE, &d.ITAE, &d.peak, &d.recovery_time, &d.TV}) figure->why = reason;
    return performance;
}

Indices indices_of(const StepResponse& response, double target, bool to_infinity) {
    Indices indices{.error = {},
                    .why_no_error = why_no_integral(response, target, to_infinity),
                    .TV = total_variation(response.nodes)};
    if (indices.why_no_error == nullptr)
        indices.error =
            error_integrals(response.nodes, target, to_infinity ? response.error_integral_final : std::nullopt);
    return indices;
}

SetpointPerformance setpoint_figures(const StepResponse& response, double step, bool to_infinity,
                                     const std::optional<Indices>& indices) {
    SetpointPerformance p;
    const auto& nodes = response.nodes;
    store(p, indices ? *indices : indices_of(response, step, to_infinity), !to_infinity && !response.settles);
    const Extremes extremes = extremes_of_y(nodes);
    p.overshoot_percent = std::max(0.0, 100 * ((step > 0 ? extremes.max : extremes.min) / step - 1));
    const auto rise = [&](double from, double to) {
        const auto a = first_reached(nodes, from * step), b = first_reached(nodes, to * step);
        return a && b ? Figure(*b - *a) : no_figure("The response does not reach that level.");
    };
    p.rise_time = rise(0.1, 0.9);
    p.rise_time_5_95 = rise(0.05, 0.95);
    p.settling_time = Figure(last_outside(nodes, step, kSettlingBand * std::abs(step)),
                             "The response does not stay within 2 % of the set point.");
    p.first_move = nodes.front().u;
    return p;
}

LoadPerformance load_figures(const StepResponse& response, bool to_infinity, const std::optional<Indices>& indices) {
    LoadPerformance p;
    const auto& nodes = response.nodes;
    store(p, indices ? *indices : indices_of(response, 0, to_infinity), !to_infinity && !response.settles);
    const Extremes extremes = extremes_of_y(nodes);
    p.peak = std::abs(extremes.max) >= std::abs(extremes.min) ? extremes.max : extremes.min;
    p.recovery_time = Figure(last_outside(nodes, 0, kSettlingBand * std::abs(*p.peak)),
                             "The response does not return to within 2 % of its peak.");
    return p;
}

NoisePerformance noise_figures(const Loop& loop, const NoiseOptions& noise) {
    const Figure gain(
        noise_gain(loop, noise.sample_time > 0 ? noise.sample_time : default_noise_sample_time(loop)),
        "The derivative has no filter: held noise samples make it infinite. Give the controller a filter.");
    return {.u_std = gain ? Figure(*gain * noise.std) : gain, .gain = gain};
}

double two_digits_up(double value) {
    if (!(value > 0)) return 0;
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
    return std::ceil(value / unit) * unit;
}

double covering_horizon(const StepResponse& setpoint, const StepResponse& load) {
    double t = 0;
    for (const StepResponse* response : {&setpoint, &load}) {
        double largest = 0;
        for (const auto& node : response->nodes) largest = std::max(largest, std::abs(node.y - response->y_final));
        t = std::max(
            t, last_outside(response->nodes, response->y_final, 0.01 * largest).value_or(response->nodes.back().t));
    }
    if (t <= 0) t = setpoint.nodes.back().t;
    return two_digits_up(1.25 * t);
}

Trace trace_of(const StepResponse& response, double horizon, int points) {
    Trace trace;
    const auto values = sampled(response.nodes, horizon, points);
    for (auto* values_of : {&trace.t, &trace.y, &trace.u}) values_of->reserve(values.size());
    for (int i = 0; i < points; ++i) {
        trace.t.push_back(horizon * i / (points - 1));
        trace.y.push_back(values[static_cast<std::size_t>(i)].first);
        trace.u.push_back(values[static_cast<std::size_t>(i)].second);
    }
    return trace;
}

}  // namespace tunewright
