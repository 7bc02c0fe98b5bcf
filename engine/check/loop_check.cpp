#include "engine/check/loop_check.h"

#include <algorithm>
#include <cmath>

#include "engine/check/action.h"
#include "engine/check/cause.h"
#include "engine/check/drawing.h"
#include "engine/check/movement.h"
#include "engine/check/oscillation/oscillation.h"
#include "engine/check/pace/given_law.h"
#include "engine/check/record_quality.h"
#include "engine/check/samples.h"
#include "engine/check/service.h"
#include "engine/check/shape.h"
#include "engine/number_text.h"

namespace tunewright::check {
namespace {

std::optional<Error> refused(const LoopQuestion& question) {
    const Record& record = question.record;
    const auto wrong = [&](const char* name, std::size_t length, bool required) -> std::optional<Error> {
        if (length == record.t.size() || (!required && length == 0)) return std::nullopt;
        return Error{ErrorKind::invalid_argument, std::string("record/") + name,
                     std::string(name) + " has " + std::to_string(length) + " values and t " +
                         std::to_string(record.t.size()) + "; they must have the same number."};
    };
    if (auto error = wrong("y", record.y.size(), true)) return error;
    if (auto error = wrong("u", record.u.size(), true)) return error;
    if (auto error = wrong("r", record.r.size(), false)) return error;
    if (auto error = wrong("automatic", record.automatic.size(), false)) return error;
    for (const auto& [name, range] : {std::pair{"range/pv", &question.y_range}, {"range/op", &question.u_range}})
        if (*range && !((**range)[0] < (**range)[1]))
            return Error{ErrorKind::invalid_argument, name,
                         "The range is not [low, high] with low < high; give the lower end first."};
    return std::nullopt;
}

std::string with_unit(double value, const std::string& unit) {
    return figure_text(value) + (unit.empty() ? "" : " " + unit);
}

/// An output without a unit is stated against its range.
UnitNames units_of(const LoopQuestion& question, const OutputRange& u_range) {
    UnitNames units = question.units;
    if (units.u.empty()) units.u = "of the output's " + text(u_range.low) + " to " + text(u_range.high);
    return units;
}

/// The period that the cause knows is the more exact one; a cycle that is too irregular for the spectrum is one
/// nevertheless.
void take_period(const OscillationStudy& study, double step, LoopCheck& check) {
    if (!check.cause.period) return;
    auto& periods = check.oscillation.periods;
    constexpr double kSame = 0.25;  // in ln
    const auto same = std::ranges::find_if(
        periods, [&](const Period& period) { return std::abs(std::log(period.period / *check.cause.period)) < kSame; });
    Period first = same != periods.end() ? *same : oscillation_of(study, *check.cause.period, step);
    if (same != periods.end()) periods.erase(same);
    first.period = *check.cause.period;
    periods.insert(periods.begin(), first);
    check.oscillation.found = true;
}

}  // namespace

std::string UnitNames::time_text(double value) const { return with_unit(value, time); }
std::string UnitNames::y_text(double value) const { return with_unit(value, y); }
std::string UnitNames::u_text(double value) const { return with_unit(value, u); }

Expected<LoopCheck> check_loop(const LoopQuestion& question, const std::stop_token& stop) {
    if (question.unreadable) return unreadable_loop(question.tag, *question.unreadable);
    if (auto error = refused(question)) return *error;
    LoopCheck check;
    check.tag = question.tag;
    check.kind = question.kind;
    check.weight = question.weight;
    const Rows rows = rows_of(question.record);
    const Samples samples = even_samples(rows);
    check.quality = quality_of(rows, samples, question.y_range);
    check.quality.readings = question.readings;
    for (const std::string& note : question.notes)
        check.quality.remarks.push_back({"file-read", note, WarningLevel::warning});
    const auto u_range = output_range(question, samples);
    check.units = units_of(question, u_range);
    ChosenLaw law = chosen_law(question, samples, u_range, check.units);
    check.law = law.law;
    if (law.differs) check.quality.remarks.push_back(std::move(*law.differs));
    check.service = service_of(samples, u_range, check.quality.u_step, check.law);
    check.performance = no_performance("The record has no usable rows.");
    if (!samples.y.empty()) {
        check.performance = performance_of(samples, u_range, question);
        check.trend = trend_of(samples);
    }
    if (stop.stop_requested()) return Error{ErrorKind::cancelled, "", "The check was stopped."};
    if (check.quality.enough) {
        const OscillationStudy study = study_oscillation(samples);
        check.oscillation = study.found;
        if (stop.stop_requested()) return Error{ErrorKind::cancelled, "", "The check was stopped."};
        check.cause =
            cause_of({question, samples, study, u_range, check.quality, check.service, check.law, check.units}, stop);
        if (stop.stop_requested()) return Error{ErrorKind::cancelled, "", "The check was stopped."};
        take_period(study, samples.step, check);
        draw_details(samples, study, check);
        check.shape = shape_of(samples, check.oscillation, study, question);
    } else {
        check.cause = insufficient(check.quality);
    }
    check.action = action_for(check);
    return check;
}

LoopCheck unreadable_loop(std::string tag, std::string reason) {
    LoopCheck check;
    check.tag = std::move(tag);
    check.quality.enough = false;
    check.performance = no_performance("The record could not be read.");
    check.quality.remarks.push_back({"not-read", std::move(reason), WarningLevel::bad});
    check.cause = insufficient(check.quality);
    check.action = action_for(check);
    return check;
}

}  // namespace tunewright::check
