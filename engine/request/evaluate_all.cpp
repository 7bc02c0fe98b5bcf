#include "engine/request/evaluate_all.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "engine/evaluation/evaluate.h"
#include "engine/evaluation/evaluation_start.h"
#include "engine/request/identified_region.h"
#include "engine/request/optimum_at_ms.h"
#include "engine/request/own_step/own_steps.h"
#include "engine/request/ranking.h"
#include "engine/request/verdict/verdict.h"
#include "engine/tuning/arrieta/tradeoff_report.h"

namespace tunewright {
namespace {

// Moves an error's place from "controller/..." of one evaluation to the request's list of controllers.
Error placed(Error error, std::size_t index) {
    const std::string one = "controller";
    if (error.where.starts_with(one)) error.where.replace(0, one.size(), "controllers/" + std::to_string(index));
    return error;
}

Error out_of_time(std::size_t done) {
    return {ErrorKind::timeout, "",
            "The time limit was reached after " + std::to_string(done) + " controllers; send fewer, or fewer points."};
}

std::vector<int> by_load_IAE(const std::vector<TuningEntry>& entries) {
    std::vector<int> order(entries.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](int index) {
        return entries[static_cast<std::size_t>(index)].evaluation->performance.load.IAE.value_or(INFINITY);
    });
    return order;
}

}  // namespace

Expected<EvaluationResult> evaluate_all(const AnalysedPlant& subject, const std::vector<GivenController>& controllers,
                                        const EvaluateOptions& options,
                                        const std::optional<device::DeviceModel>& device, const verdict::Labels& labels,
                                        const RunControl& control, const IdentifiedModel* model,
                                        const verdict::GivenSteps& given_steps,
                                        const std::optional<OwnStep>& own_step) {
    const auto now = [&] { return control.now_ms ? control.now_ms() : 0; };
    if (const auto error = refuse_traces(options, controllers.size())) return *error;
    if (own_step)
        if (const auto error = refuse_own_step(*own_step)) return *error;
    EvaluationResult result;
    if (subject.equations() != nullptr) result.operating_point = operating_point(*subject.equations());
    EvaluateOptions watched = options;
    watched.stop = control.stop;
    const EvaluateOptions on_nominal = on_linearisation(subject, options);
    std::optional<Tradeoffs> tradeoffs;
    std::optional<RobustOptima> optima;
    if (options.tradeoff) tradeoffs.emplace(subject.nominal(), on_nominal);
    if (options.optimum_at_Ms.value_or(false) && subject.linear() != nullptr)
        optima.emplace(TuningProblem{*subject.nominal(), *subject.linear(), {}, {}}, on_nominal);
    for (std::size_t i = 0; i < controllers.size(); ++i) {
        if (control.stop.stop_requested()) return out_of_time(i);
        const double start = now();
        auto evaluation = evaluate(subject, controllers[i].law, watched);
        if (!evaluation && evaluation.error().kind == ErrorKind::cancelled) return out_of_time(i);
        if (!evaluation) return placed(evaluation.error(), i);
        TuningEntry& entry = result.controllers.emplace_back();
        if (tradeoffs)
            entry.reports.push_back(std::make_shared<TradeoffReport>(tradeoffs->of(controllers[i].law, std::nullopt)));
        if (optima) entry.optimum_at_Ms = optima->compare_at_Ms(*evaluation, control);
        entry.on_device = device_entry_of(subject, controllers[i], device, watched, *evaluation, control);
        if (model != nullptr) warn_of_band(*evaluation, model->excited_band);
        evaluation->compute_ms = now() - start;
        entry.evaluation = std::move(*evaluation);
    }
    const verdict::Context context{subject, options,     labels,  device ? device->Ts : 0,        model,
                                   nullptr, given_steps, control, own_step ? &*own_step : nullptr};
    const auto device_of = [&](const TuningEntry& entry) {
        const auto& typed = controllers[static_cast<std::size_t>(&entry - result.controllers.data())].typed;
        return typed ? &typed->device : device ? &*device : nullptr;
    };
    if (!simulate_own_steps(result.controllers, subject, own_step, options.points, device_of, control))
        return out_of_time(result.controllers.size());
    draw_together(result.controllers);
    const RankingTerms terms = ranking_terms(options, subject.linear() != nullptr);
    ranked(result.controllers, terms);
    verdict::judge(result.controllers, context);
    result.verdict = verdict::of_all(result.controllers, by_load_IAE(result.controllers), context, false);
    if (!result.controllers.empty()) result.rank_Ms = terms.rank_Ms;
    result.proposed = verdict::proposed(result.controllers, result.verdict);
    return result;
}

}  // namespace tunewright
