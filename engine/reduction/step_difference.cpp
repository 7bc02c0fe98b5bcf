#include "engine/reduction/step_difference.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/cubic.h"
#include "engine/reduction/step_reading.h"
#include "engine/simulation/linear/step_response.h"

namespace tunewright {
namespace {

// Times after the model's dead time, in time constants: steps over which a cubic through e^-t errs by about 1e-6 in
// area.
const std::vector<double> kModelTimes = [] {
    std::vector<double> times;
    for (double t = 0.12; t < 20; t += 0.12 * std::exp(t / 5)) times.push_back(t);
    return times;
}();

Signal response(const ReducedModel& model, double t) {
    if (t < 0) return {};
    const double left = model.T1 > 0 ? std::exp(-t / model.T1) : 0;
    if (model.integrators == 1) return {model.K * (t - model.T1 * (1 - left)), model.K * (1 - left)};
    return {model.K * (1 - left), model.T1 > 0 ? model.K * left / model.T1 : 0};
}

}  // namespace

// What is left of the decaying modes at the end would add up in integrals weighted with time: it is cut off.
StepDifference::TracePoint StepDifference::at_rest(const LinearPlant& plant, double t) {
    const double K = plant.low_frequency_gain();
    if (plant.integrators() == 0) return {t, K, 0};
    const auto asymptote = ramp_delay(plant);
    return {t, K * (t - asymptote), K};
}

StepDifference::StepDifference(const LinearPlant& plant, std::optional<double> horizon) {
    const double L = plant.dead_time();
    trace_.push_back({});
    if (L > 0) trace_.push_back({L, 0, 0});
    const auto samples = step_response(plant);
    for (const auto& sample : samples) trace_.push_back({L + sample.t, sample.y, sample.slope});
    if (!horizon) {
        trace_.push_back(at_rest(plant, trace_.back().t));
        return;
    }
    ends_at_horizon_ = true;
    const double after = *horizon - L;
    while (trace_.size() > 1 && trace_.back().t > *horizon) trace_.pop_back();
    if (after > 0) {
        const auto last = std::ranges::find_if(samples, [&](const StepSample& s) { return s.t > after; }) - 1;
        const StepSample end = step_response_after(plant.realisation(), *last, after - last->t);
        trace_.push_back({*horizon, end.y, end.slope});
    } else {
        trace_.push_back({*horizon, 0, 0});
    }
}

// Before point `next` of the trace a cubic, after its last one a straight line.
StepDifference::TracePoint StepDifference::plant_at(size_t next, double t) const {
    const TracePoint& a = trace_[next - 1];
    if (next == trace_.size()) return {t, a.y + a.slope * (t - a.t), a.slope};
    const TracePoint& b = trace_[next];
    const Cubic y = hermite_taylor(b.t - a.t, {a.y, a.slope}, {b.y, b.slope});
    return {t, value_at(y, t - a.t), slope_at(y, t - a.t)};
}

// Rising; the dead time twice, for the jump of the slope (of y where there is no lag).
std::vector<double> StepDifference::model_times(const ReducedModel& model) const {
    std::vector<double> times;
    const double first = trace_[1].t;  // the plant's dead time: before it the trace has no points
    for (int k = 1; model.L < first && k < 8; ++k) times.push_back(model.L + (first - model.L) * k / 8);
    for (const double factor : kModelTimes) times.push_back(model.L + factor * model.T1);
    if (ends_at_horizon_) std::erase_if(times, [&](double t) { return t >= trace_.back().t; });
    std::ranges::sort(times);
    if (!(ends_at_horizon_ && model.L >= trace_.back().t)) times.insert(times.begin(), {model.L, model.L});
    return times;
}

// The difference just before and just after the model's dead time are the nodes of the first two times.
std::vector<ResponseNode> StepDifference::nodes(const ReducedModel& model) const {
    const std::vector<double> times = model_times(model);
    std::vector<ResponseNode> nodes;
    nodes.reserve(trace_.size() + times.size());
    const auto add = [&](const TracePoint& p, bool model_runs) {
        const Signal of_model = model_runs ? response(model, p.t - model.L) : Signal{};
        ResponseNode node{.t = p.t, .y = p.y - of_model.value, .y_slope = p.slope - of_model.slope};
        if (!nodes.empty()) {
            const ResponseNode& last = nodes.back();
            node.error_integral =
                last.error_integral - hermite_integral(node.t - last.t, {last.y, last.y_slope}, {node.y, node.y_slope});
        }
        nodes.push_back(node);
    };
    size_t i = 0;
    for (size_t k = 0; k < times.size(); ++k) {
        for (; i < trace_.size() && trace_[i].t <= times[k]; ++i) add(trace_[i], k > 0);
        add(plant_at(i, times[k]), k > 0);
    }
    for (; i < trace_.size(); ++i) add(trace_[i], !times.empty());
    return nodes;
}

ErrorIntegrals StepDifference::to(const ReducedModel& model) const {
    return error_integrals(nodes(model), 0, std::nullopt);
}

double StepDifference::absolute(const ReducedModel& model) const {
    return integral_of_absolute_error(nodes(model), 0, std::nullopt);
}

}  // namespace tunewright
