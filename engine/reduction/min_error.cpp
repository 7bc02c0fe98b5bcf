#include "engine/reduction/min_error.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "engine/number_text.h"
#include "engine/numerics/local_minimum.h"
#include "engine/reduction/step_difference.h"
#include "engine/reduction/step_reading.h"
#include "engine/reduction/tangent.h"
#include "engine/reduction/two_point_123c.h"

namespace tunewright {
namespace {

constexpr double kMinLag = 1e-6;     // of the time scale
constexpr double kLargestLag = 1e4;  // of the time scale

double criterion(ReductionMethod method, const StepDifference& difference, const ReducedModel& model) {
    if (method == ReductionMethod::min_iae) return difference.absolute(model);
    const ErrorIntegrals integrals = difference.to(model);
    return method == ReductionMethod::min_ise ? integrals.ISE : integrals.ITAE;
}

// What is searched for, in units of its own: L and ln T; with an integrator L alone where T follows from it or is 0;
// with a horizon K too.
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
    ReducedModel least(const ReducedModel& start) const;
    double moved() const { return difference_.moved(); }

private:
    StepDifference difference_;
    ReductionMethod method_;
    double scale_, K_;
    int integrators_;
    bool fits_T_, fits_K_;
    std::optional<double> ramp_delay_;  // where it ties L to T
};

ReducedModel ModelSearch::model(const std::vector<double>& x) const {
    ReducedModel model{.integrators = integrators_, .K = K_};
    model.L = std::max(0.0, x[0]) * scale_;
    if (fits_T_) model.T1 = std::clamp(std::exp(x[1]), kMinLag, kLargestLag) * scale_;
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

// A simplex, then subspaces from where it stopped: a kink of |.| may stall a simplex.
ReducedModel ModelSearch::least(const ReducedModel& start) const {
    std::vector<double> x = unknowns(start);
    const double unit = cost(start);
    if (!(unit > 0)) return start;
    const auto f = [&](const std::vector<double>& at, bool&) {
        const double outside = std::max(0.0, -at[0]);  // dead times below 0 count as 0, and cost something
        return cost(model(at)) / unit + outside;
    };
    for (const auto& [search, size, tolerance] :
         {std::tuple{LocalSearch::nelder_mead, 0.1, 1e-5}, {LocalSearch::subplex, 0.01, 1e-6}})
        x = find_local_minimum(search, f, x, {std::vector<double>(x.size(), size), tolerance, 150}).x;
    return model(x);
}

// Moments (dead time and lags shared out), and what two points or the tangent say where they apply.
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
    return std::max({plant.lag_sum(), slowest, 1e-3 * plant.dead_time()});
}

Error nothing_moved(double horizon, const LinearPlant& plant) {
    return {ErrorKind::invalid_argument, "reduction/horizon",
            "horizon is " + text(horizon) + "; by then the step response has not moved (the dead time is " +
                text(plant.dead_time()) + "). Give a horizon that the response has settled by, or leave it out."};
}

}  // namespace

Expected<ReducedModel> min_error(const LinearPlant& plant, const ReductionRequest& request) {
    if (plant.integrators() == 1 && ramp_delay(plant) < 0) return ramp_asymptote(plant);  // its error
    if (plant.integrators() == 1 && !request.horizon && request.order == ReducedOrder::first)
        return ramp_asymptote(plant);
    const double scale = time_scale(plant);
    const ModelSearch search(plant, request, scale);
    if (request.horizon && !(std::abs(search.moved()) > 1e-6 * std::abs(plant.low_frequency_gain())))
        return nothing_moved(*request.horizon, plant);

    auto models = starts(plant, scale);
    std::ranges::sort(models, {}, [&](const ReducedModel& model) { return search.cost(model); });
    ReducedModel best = search.least(models.front());
    best.warnings = plant.integrators() == 0 ? monotonicity_warnings(step_response(plant), plant.low_frequency_gain())
                                             : std::vector<Warning>{};
    if (request.horizon && best.T1 > *request.horizon)
        best.warnings.push_back({"short-horizon", "The model's time constant, " + text(best.T1) +
                                                      ", exceeds the horizon " + text(*request.horizon) +
                                                      ": the part of the response that was fitted hardly tells it. "
                                                      "Give a longer horizon."});
    return best;
}

}  // namespace tunewright
