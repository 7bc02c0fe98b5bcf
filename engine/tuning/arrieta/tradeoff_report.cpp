#include "engine/tuning/arrieta/tradeoff_report.h"

#include <cmath>
#include <utility>

#include "engine/evaluation/evaluate.h"
#include "engine/number_text.h"
#include "engine/reduction/reduction.h"
#include "engine/tuning/arrieta/arrieta_rule.h"

namespace tunewright {
namespace {

constexpr const char* kOnlyPoints =
    "The plant is known only by points of its frequency response, so its response over time is unknown.";
constexpr double kMaxDegradationError = 0.03;  // of a degradation: largest error of the table for L/T from 0.1 to 1.5
constexpr int kMsPoints = 13;                  // 1.4, 1.45 ... 2

void add_point(std::vector<ProfilePoint>& points, double level, const ArrietaConstants& constants, const Fopdt& model,
               const TradeoffScale& scale) {
    const IdealPid pid = arrieta_pid(constants, model);
    if (pid.Td < 0) return;
    const TradeoffFigures f = scale.figures(to_parallel(pid));
    if (f.Deg && f.Ms) points.push_back({level, *f.Ms, *f.J_r, *f.J_d, *f.J_rd, *f.I_perf, *f.Deg});
}

TradeoffProfile profile_on(const Fopdt& model, const TradeoffScale& scale) {
    TradeoffProfile profile;
    for (int i = 0; i < kMsPoints; ++i) {
        const double Ms = (28 + i) / 20.0;
        add_point(profile.by_Ms, Ms, arrieta_equation_9(Ms, ArrietaC3::refitted), model, scale);
    }
    for (const ArrietaLevel& column : arrieta_degradation_levels())
        add_point(profile.by_degradation, column.level, column.constants, model, scale);
    return profile;
}

bool same(const Plant& plant, const Fopdt& model) {
    const auto* fopdt = std::get_if<Fopdt>(&plant);
    return fopdt && fopdt->K == model.K && fopdt->T == model.T && fopdt->L == model.L;
}

}  // namespace

Tradeoffs::Tradeoffs(std::optional<Plant> nominal, const EvaluateOptions& options) : nominal_(std::move(nominal)) {
    steps_.setpoint_step = options.setpoint_step;
    steps_.load_step = options.load_step;
    steps_.points = 0;
    if (nominal_) linear_ = *LinearPlant::make(*nominal_);
}

const Tradeoffs::OnModel& Tradeoffs::scales(const Fopdt& model) {
    const std::array<double, 3> key = {model.K, model.T, model.L};
    if (const auto at = kept_.find(key); at != kept_.end()) return at->second;
    auto references = reference_controllers(model);
    TradeoffScale on_model(*LinearPlant::make(model), references), on_plant(*linear_, references);
    return kept_.emplace(key, OnModel{std::move(references), std::move(on_model), std::move(on_plant)}).first->second;
}

// The responses of a nonlinear controller cannot be computed from its gains alone.
TradeoffFigures Tradeoffs::figures(const TradeoffScale& scale, const Plant& plant, const Controller& controller) const {
    const auto K = scale.static_gain();
    if (!K || !std::holds_alternative<Npid>(controller)) return scale.figures(gains(controller));
    const auto evaluation = evaluate(PlantModel(plant), controller, steps_);
    if (!evaluation) return no_tradeoff(evaluation.error().message);
    const Performance& p = evaluation->performance;
    const auto per_unit = [](std::optional<double> IAE, double step) {
        return IAE ? std::optional(*IAE / std::abs(step)) : std::nullopt;
    };
    if (!evaluation->robustness.stable) return scale.figures(gains(controller));
    return scale.placed(evaluation->robustness.Ms, per_unit(p.setpoint.IAE, steps_.setpoint_step),
                        per_unit(p.load.IAE, steps_.load_step * *K), "The response has no finite IAE.");
}

TradeoffReport Tradeoffs::against(const Fopdt& model, const Controller& controller) {
    const OnModel& scale = scales(model);
    TradeoffReport entry;
    entry.fopdt = model;
    entry.model = figures(scale.on_model, model, controller);
    entry.plant = same(*nominal_, model) ? entry.model : figures(scale.on_plant, *nominal_, controller);
    return entry;
}

Expected<Fopdt> Tradeoffs::model_for(const std::optional<Plant>& reduced_model) const {
    for (const auto& plant : {reduced_model, nominal_})
        if (plant && std::holds_alternative<Fopdt>(*plant)) {
            const auto& given = std::get<Fopdt>(*plant);
            return Fopdt{.K = given.K, .T = given.T, .L = given.L};
        }
    const auto reduced = reduce(*linear_, {.order = ReducedOrder::first, .preferred = ReductionMethod::two_point_123c});
    if (!reduced) return reduced.error();
    if (reduced->integrators > 0)
        return Error{ErrorKind::unsupported, "plant", "An integrating plant has no stable first-order model."};
    return Fopdt{.K = reduced->K, .T = reduced->T1, .L = reduced->L};
}

TradeoffReport Tradeoffs::of(const Controller& controller, const std::optional<Plant>& reduced_model) {
    TradeoffReport entry;
    if (!linear_) {
        entry.model = entry.plant = no_tradeoff(kOnlyPoints);
        return entry;
    }
    const auto model = model_for(reduced_model);
    if (model) return against(*model, controller);
    entry.model = no_tradeoff(model.error().message);
    entry.plant = figures(TradeoffScale(*linear_, model.error()), *nominal_, controller);
    return entry;
}

TradeoffReport Tradeoffs::of_rule(const Controller& controller, const ArrietaSettings& settings) {
    TradeoffReport entry = against(settings.model, controller);
    entry.rule = settings;
    entry.constants = settings.constants;
    entry.Ms_design = settings.Ms_design;
    if (settings.profile) entry.profile = profile_on(settings.model, scales(settings.model).on_model);
    return entry;
}

void TradeoffReport::complete(const ReportContext& context, Evaluation& evaluation) {
    if (!rule) return;
    *this = context.tradeoffs.of_rule(evaluation.controller, ArrietaSettings(*rule));
    if (!rule->degradation || !model.Deg || std::abs(*model.Deg - *rule->degradation) <= kMaxDegradationError) return;
    evaluation.warnings.push_back({"degradation-missed", "On the model the degradation is " + text(*model.Deg) +
                                                             ", not the " + text(*rule->degradation) +
                                                             " of Table 2's column; exact = true solves for it."});
}

}  // namespace tunewright
