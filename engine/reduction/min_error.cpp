#include "engine/reduction/min_error.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "engine/number_text.h"
#include "engine/numerics/cubic.h"
#include "engine/numerics/optimise/direct_search.h"
#include "engine/reduction/step_reading.h"
#include "engine/simulation/linear/step_response.h"

namespace tunewright {
namespace {

// Times after the model's dead time, in time constants: steps over which a cubic through e^-t has an error of about
// 1e-6 in area.
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

// Sets the rest of the decaying modes at the end to 0, because it would add up in integrals weighted with time.
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

// Interpolates by a cubic before point `next` of the trace, by a straight line after its last one.
StepDifference::TracePoint StepDifference::plant_at(size_t next, double t) const {
    const TracePoint& a = trace_[next - 1];
    if (next == trace_.size()) return {t, a.y + a.slope * (t - a.t), a.slope};
    const TracePoint& b = trace_[next];
    const Cubic y = hermite_taylor(b.t - a.t, {a.y, a.slope}, {b.y, b.slope});
    return {t, value_at(y, t - a.t), slope_at(y, t - a.t)};
}

// Ascending; the dead time twice, for the jump of the slope (or of y without a lag).
std::vector<double> StepDifference::model_times(const ReducedModel& model) const {
    std::vector<double> times;
    const double first = trace_[1].t;  // before the plant's dead time the trace has no points
    for (int k = 1; model.L < first && k < 8; ++k) times.push_back(model.L + (first - model.L) * k / 8);
    for (const double factor : kModelTimes) times.push_back(model.L + factor * model.T1);
    if (ends_at_horizon_) std::erase_if(times, [&](double t) { return t >= trace_.back().t; });
    std::ranges::sort(times);
    if (!(ends_at_horizon_ && model.L >= trace_.back().t)) times.insert(times.begin(), {model.L, model.L});
    return times;
}

// The differences just before and just after the model's dead time are the nodes of the first two times.
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

namespace {

constexpr double kMinLag = 1e-6;            // of the time scale
constexpr double kMinScale = 1e-3;          // of the dead time, for a plant that is nearly a pure dead time
constexpr double kMinResponseShare = 1e-6;  // of the static gain or slope: a smaller response cannot be fitted
constexpr int kMaxEvaluations = 150;        // of each search; most reach their tolerance earlier
constexpr double kMaxLag = 1e4;             // of the time scale

double criterion(ReductionMethod method, const StepDifference& difference, const ReducedModel& model) {
    if (method == ReductionMethod::min_iae) return difference.absolute(model);
    const ErrorIntegrals integrals = difference.to(model);
    return method == ReductionMethod::min_ise ? integrals.ISE : integrals.ITAE;
}

// The unknowns, in natural units: L and ln T; with an integrator only L if T follows from it or is 0; with a horizon K
// too.
class ModelSearch {
public:
    ModelSearch(const LinearPlant& plant, const ReductionRequest& request, double scale)
        : difference_(plant, request.horizon),
          method_(request.method),
          scale_(scale),
          K_(plant.low_frequency_gain()),
          integrators_(plant.integrators()),
          fits_T_(integrators_ == 0 || (request.order == ReducedOrder::second && request.horizon)),
          fits_K_(integrators_ == 0 && request.horizon),
          ramp_delay_(integrators_ == 1 && !request.horizon ? std::optional(::tunewright::ramp_delay(plant))
                                                            : std::nullopt) {}

    ReducedModel model(const std::vector<double>& x) const;
    std::vector<double> unknowns(const ReducedModel& model) const;
    double cost(const ReducedModel& model) const { return criterion(method_, difference_, model); }
    ReducedModel min(const ReducedModel& start) const;
    double moved() const { return difference_.moved(); }

private:
    StepDifference difference_;
    ReductionMethod method_;
    double scale_, K_;
    int integrators_;
    bool fits_T_, fits_K_;
    std::optional<double> ramp_delay_;  // with it L determines T
};

ReducedModel ModelSearch::model(const std::vector<double>& x) const {
    ReducedModel model{.integrators = integrators_, .K = K_};
    model.L = std::max(0.0, x[0]) * scale_;
    if (fits_T_) model.T1 = std::clamp(std::exp(x[1]), kMinLag, kMaxLag) * scale_;
    if (ramp_delay_) {
        model.L = std::min(model.L, *ramp_delay_);
        model.T1 = *ramp_delay_ - model.L;
    }
    if (fits_K_) model.K *= x[2];
    return model;
}

std::vector<double> ModelSearch::unknowns(const ReducedModel& model) const {
    std::vector<double> x{model.L / scale_};
    if (fits_T_) x.push_back(std::log(std::max(model.T1 / scale_, kMinLag)));
    if (fits_K_) x.push_back(model.K / K_);
    return x;
}

// A simplex, then subspaces from its end, because a kink of |.| may stall a simplex.
ReducedModel ModelSearch::min(const ReducedModel& start) const {
    std::vector<double> x = unknowns(start);
    const double unit = cost(start);
    if (!(unit > 0)) return start;
    const auto f = [&](const std::vector<double>& at, bool&) {
        const double outside = std::max(0.0, -at[0]);  // negative dead times count as 0, with a penalty
        return cost(model(at)) / unit + outside;
    };
    for (const auto& [search, size, tolerance] :
         {std::tuple{LocalSearch::nelder_mead, 0.1, 1e-5}, {LocalSearch::subplex, 0.01, 1e-6}})
        x = find_local_minimum(search, f, x, {std::vector<double>(x.size(), size), tolerance, kMaxEvaluations}).x;
    return model(x);
}

// Starts: by moments (dead time and lags shared out), and by the two-point and tangent reductions if they apply.
std::vector<ReducedModel> starts(const LinearPlant& plant, double scale) {
    std::vector<ReducedModel> models;
    const double K = plant.low_frequency_gain(), L = plant.dead_time();
    models.push_back({.integrators = plant.integrators(), .K = K, .T1 = 0.7 * scale, .L = L + 0.3 * scale});
    for (const auto& model : {two_point_123c(plant, ReducedOrder::second), tangent(plant, TangentTime::at_63_percent)})
        if (model) models.push_back(*model);
    return models;
}

double time_scale(const LinearPlant& plant) {
    double slowest = 0;
    for (const auto pole : plant.poles()) slowest = std::max(slowest, 1 / std::abs(pole));
    return std::max({plant.lag_sum(), slowest, kMinScale * plant.dead_time()});
}

Error nothing_moved(double horizon, const LinearPlant& plant) {
    return {ErrorKind::invalid_argument, "reduction/horizon",
            "horizon is " + text(horizon) + ", but the step response has not moved by then (the dead time is " +
                text(plant.dead_time()) + "). Give a horizon by which the response has settled, or omit it."};
}

}  // namespace

Expected<ReducedModel> min_error(const LinearPlant& plant, const ReductionRequest& request) {
    if (plant.integrators() == 1 && ramp_delay(plant) < 0) return ramp_asymptote(plant);  // its error
    if (plant.integrators() == 1 && !request.horizon && request.order == ReducedOrder::first)
        return ramp_asymptote(plant);
    const double scale = time_scale(plant);
    const ModelSearch search(plant, request, scale);
    if (request.horizon && !(std::abs(search.moved()) > kMinResponseShare * std::abs(plant.low_frequency_gain())))
        return nothing_moved(*request.horizon, plant);

    auto models = starts(plant, scale);
    std::ranges::sort(models, {}, [&](const ReducedModel& model) { return search.cost(model); });
    ReducedModel best = search.min(models.front());
    best.warnings = plant.integrators() == 0 ? monotonicity_warnings(step_response(plant), plant.low_frequency_gain())
                                             : std::vector<Warning>{};
    if (request.horizon && best.T1 > *request.horizon)
        best.warnings.push_back(
            {"short-horizon", "The model's time constant, " + text(best.T1) + ", exceeds the horizon " +
                                  text(*request.horizon) +
                                  ", so the fitted part of the response hardly depends on it. Give a longer horizon."});
    return best;
}

}  // namespace tunewright
