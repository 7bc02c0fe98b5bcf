#include "engine/request/check/cure.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/number_text.h"
#include "engine/request/recorded_controller.h"
#include "engine/request/tune.h"
#include "engine/tuning/limits.h"

namespace tunewright {
namespace {

constexpr std::size_t kMostRows = 3000;  // of a record that settings are designed from
constexpr double kRowsPerTi = 20;        // at least: the loop's own moves stay resolved

std::optional<IdealPid> ideal_pid(const ParallelPid& given) {
    const auto ideal = to_ideal(given);
    return ideal ? std::optional(*ideal) : std::nullopt;
}

LoopCure with_test(const check::LoopCheck& check, const std::string& why, std::optional<IdealPid> today) {
    LoopCure cure;
    cure.today = std::move(today);
    cure.test = plan_test(check);
    cure.detail = why;
    cure.worst_Ms = cure.error_ratio = no_figure("There are no settings before the test.");
    return cure;
}

/// The entry of the design: the first that is not today's settings, with an evaluation.
const TuningEntry* design_of(const TuningResult& result) {
    for (const int i : result.ranking) {
        const TuningEntry& entry = result.controllers[static_cast<std::size_t>(i)];
        if (!entry.is_baseline() && entry.evaluation) return &entry;
    }
    return nullptr;
}

/// True if the limit holds on every plant that fits the record.
bool holds_on_region(const TuningEntry& entry) {
    const auto worst = worst_Ms(entry);
    return worst && !worst->exceeds(entry.Ms_limit.value_or(limits::kDefaultMs));
}

LoopCure with_settings(const TuningResult& result, const TuningEntry& entry, std::optional<IdealPid> today) {
    LoopCure cure;
    cure.today = std::move(today);
    cure.settings = std::get<IdealPid>(entry.evaluation->controller);
    if (result.model) cure.plant = result.model->plant;
    if (const auto worst = worst_Ms(entry)) cure.worst_Ms = worst->value;
    cure.error_ratio = entry.replay ? Figure(entry.replay->IAE_ratio) : no_figure("The record has no set point.");
    cure.detail =
        "The record shows the plant: with the new settings Ms stays within its limit on every plant that fits "
        "the record.";
    if (cure.error_ratio)
        cure.detail += " In the recorded time the mean error would have been " + figure_text(*cure.error_ratio) +
                       " times as large.";
    return cure;
}

/// Every few rows of a long record: identification and replay cost by the row, and a loop moves slowly against them.
Record thinned(const Record& record, const check::LoopCheck& check) {
    const double rows_of_Ti = check.law.Ti / std::max(check.quality.sample_time, 1e-300);
    const double most = std::isfinite(rows_of_Ti) ? std::floor(rows_of_Ti / kRowsPerTi) : 1;
    const double wanted = std::ceil(double(record.t.size()) / double(kMostRows));
    const auto every = static_cast<std::size_t>(std::max(1.0, std::min(most, wanted)));
    if (every == 1) return record;
    Record out = record;
    const auto thin = [every](auto& values) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < values.size(); i += every) values[kept++] = values[i];
        values.resize(kept);
    };
    thin(out.t);
    thin(out.y);
    thin(out.u);
    thin(out.r);
    thin(out.automatic);
    return out;
}

LoopCure until_repair(const check::LoopQuestion& question, const check::LoopCheck& check, const RunControl& control) {
    LoopCure cure;
    cure.valve = check::cycle_stops(question, check, control.stop);
    if (cure.valve->outcome != check::CycleStops::Outcome::not_told)
        cure.today = IdealPid{.Kp = check.law.gain, .Ti = check.law.Ti};
    cure.detail = cure.valve->detail;
    cure.worst_Ms = cure.error_ratio = no_figure("Repair the valve first.");
    return cure;
}

}  // namespace

std::optional<LoopCure> cure_of(const check::LoopQuestion& question, const check::LoopCheck& check,
                                const RunControl& control) {
    if (check.action.code == check::ActionCode::repair_valve) return until_repair(question, check, control);
    if (check.action.code == check::ActionCode::test)
        return with_test(check, "The cause is open, so nothing is designed.", std::nullopt);
    if (check.action.code != check::ActionCode::retune) return std::nullopt;
    TuningRequest request;
    request.record = thinned(question.record, check);
    if (question.u_range) request.record->u_limits = question.u_range;
    request.evaluate.points = 0;
    std::optional<IdealPid> today;
    if (check.law.given)
        today = ideal_pid(*question.controller);
    else if (auto recorded = recorded_controller(*request.record, nullptr))
        today = recorded->found.pid;
    if (today) request.baseline = GivenController(*today);
    const auto result = tune(request, {control.stop, nullptr, control.now_ms});
    if (!result) return with_test(check, result.error().message, std::move(today));
    // What cannot be replayed over the recorded time has a plant that the record leaves open.
    if (result->replay && result->replay->refused)
        return with_test(check, reason_of(*result->replay->refused), std::move(today));
    const TuningEntry* entry = design_of(*result);
    if (entry == nullptr || !std::holds_alternative<IdealPid>(entry->evaluation->controller))
        return with_test(check, "No design holds its limits on the plants that fit this record.", std::move(today));
    if (!holds_on_region(*entry))
        return with_test(check, "The record leaves the plant so open that no settings are safe on all that fit it.",
                         std::move(today));
    if (entry->replay && entry->replay->refused)
        return with_test(check, reason_of(*entry->replay->refused), std::move(today));
    return with_settings(*result, *entry, std::move(today));
}

}  // namespace tunewright
