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

constexpr std::size_t kMostRows = 6000;  // of a record that settings are designed from
constexpr double kClearlyMore = 1.001;   // of the set point's moves: rounding finds no better part

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

/// The part of a long record in which the set point moves most, else its end: identification and replay cost by the
/// row.
Record telling_part(const Record& record) {
    const std::size_t n = record.t.size();
    if (n <= kMostRows) return record;
    std::size_t end = n;
    double most = 0, moved = 0;
    const auto move = [&](std::size_t i) {
        return i > 0 && i < record.r.size() ? std::abs(record.r[i] - record.r[i - 1]) : 0;
    };
    for (std::size_t i = 0; i < n; ++i) {
        moved += move(i);
        if (i >= kMostRows) moved -= move(i - kMostRows);
        if (i + 1 >= kMostRows && moved > kClearlyMore * most) {
            most = moved;
            end = i + 1;
        }
    }
    Record out = record;
    const auto cut = [&](auto& values) {
        if (values.size() != n) return;
        values.erase(values.begin() + std::ptrdiff_t(end), values.end());
        values.erase(values.begin(), values.begin() + std::ptrdiff_t(end - kMostRows));
    };
    cut(out.t);
    cut(out.y);
    cut(out.u);
    cut(out.r);
    cut(out.automatic);
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
    request.record = telling_part(question.record);
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
