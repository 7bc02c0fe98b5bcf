#include "engine/identification/closed_loop/cold_start.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/identification/closed_loop/feedback.h"
#include "engine/identification/model_grade.h"
#include "engine/identification/record/record_kind.h"
#include "engine/identification/record/series.h"
#include "engine/number_text.h"
#include "engine/numerics/statistics.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {
namespace {

constexpr double kMinDeparture = 0.02;  ///< of y's range: after a larger change y is no longer at rest
constexpr double kNoiseDeviations = 4;  ///< standard deviations of noise, which count as no movement

/// Number of rows in which u is constant at its first value.
std::size_t still_rows(const std::vector<double>& u) {
    return static_cast<std::size_t>(std::ranges::find_if(u, [&](double v) { return v != u.front(); }) - u.begin());
}

/// True if u moves up to this row by small moves, or by single steps of its grid, and not by a deliberate step.
bool creeps(const std::vector<double>& u, std::size_t row) {
    constexpr double kMaxStepShare = 0.5, kMaxStepInGrids = 1.5;  // of the whole change; in steps of the grid
    constexpr std::size_t kMaxFewLevels = 3;                      // so few levels do not define a grid
    if (std::set<double>(u.begin(), u.end()).size() <= kMaxFewLevels) return false;
    double largest = 0;
    for (std::size_t i = 1; i <= row && i < u.size(); ++i) largest = std::max(largest, std::abs(u[i] - u[i - 1]));
    const double way = std::abs(u[std::min(row, u.size() - 1)] - u.front());
    return largest <= std::max(kMaxStepShare * way, kMaxStepInGrids * quantisation_step(u));
}

/// The static gain; empty if the plant integrates.
std::optional<double> gain_of(const IdentifiedModel& model) {
    const auto plant = LinearPlant::make(model.plant);
    return plant && plant->integrators() == 0 ? std::optional(plant->low_frequency_gain()) : std::nullopt;
}

bool knows_gain(const IdentifiedModel& model) {
    constexpr double kMaxKnownGainError = 0.1;  // standard error over the gain
    const std::optional<double> K = gain_of(model);
    const auto error = model.standard_errors.find("K");
    return K && error != model.standard_errors.end() && error->second < kMaxKnownGainError * std::abs(*K);
}

bool same_sign(const IdentifiedModel& a, const IdentifiedModel& b) {
    const std::optional<double> one = gain_of(a), other = gain_of(b);
    return one && other && *one * *other > 0;
}

/// True if the gains differ by less than a tenth, or by less than three standard errors.
bool agree(const IdentifiedModel& estimated, const IdentifiedModel& from_off) {
    constexpr double kMaxGainDifference = 0.1, kGainStandardErrors = 3;
    const std::optional<double> one = gain_of(estimated), other = gain_of(from_off);
    const double max =
        one ? kMaxGainDifference * std::abs(*one) + kGainStandardErrors * estimated.standard_errors.at("K") : 0;
    return one && other && std::abs(*one - *other) < max;
}

IdentifiedModel warned(IdentifiedModel model, const std::string& taken, WarningLevel level) {
    model.warnings.insert(
        model.warnings.begin(),
        {"u0-not-recorded",
         "The record begins after u has moved, with y still at rest, so it does not contain the previous value of "
         "u. " +
             taken +
             " The gain K and the lags depend on that: give u0, the value of u before the first row, or start the "
             "record five rows before the switch.",
         level});
    return model;
}

}  // namespace

double off_level(const Record& record) { return record.u_limits ? std::max(0.0, (*record.u_limits)[0]) : 0.0; }

ColdStart cold_start(const Record& record, const CleanRecord& clean, bool in_loop) {
    constexpr double kMinTravel = 0.5;     // of y's range
    constexpr std::size_t kFirstRows = 3;  // rows that may all lie within the dead time
    constexpr std::size_t kShortest = 10 * kRestRows;
    if (record.u0 || clean.samples() < static_cast<int>(kShortest)) return ColdStart::none;
    const std::span<const double> y(clean.y);
    const std::vector<double> v = input_at_samples(clean);
    const auto [low, high] = std::ranges::minmax(v);
    const double off = (off_level(record) - clean.scale.u_rest) / clean.scale.u_scale;
    if (v.front() == off || (low < off && high > off)) return ColdStart::none;
    if (!record.r.empty() && std::ranges::any_of(record.r, [&](double r) { return r != record.r.front(); }))
        return ColdStart::none;
    const double first = mean(y.first(kFirstRows)), end = mean(y.last(y.size() / 5));
    if (std::abs(end - first) < kMinTravel) return ColdStart::none;
    const double sign = end > first ? 1 : -1,
                 max = kMinDeparture + kNoiseDeviations * noise_std(y) + quantisation_step(y);
    if (std::ranges::any_of(y, [&](double value) { return sign * (value - first) < -max; })) return ColdStart::none;
    const std::size_t still = still_rows(v);
    if (still >= kRestRows && sign * (y[still - 1] - first) > max) return ColdStart::plain;
    if (in_loop && still < kRestRows) return ColdStart::plain;
    const auto leaves = std::ranges::find_if(y, [&](double value) { return sign * (value - first) > max; });
    const bool controlled = in_loop || may_be_controlled(clean);
    return controlled && creeps(v, static_cast<std::size_t>(leaves - y.begin())) ? ColdStart::possible
                                                                                 : ColdStart::none;
}

Expected<IdentifiedModel> cold_start_model(ColdStart start, Expected<IdentifiedModel> estimated,
                                           Expected<IdentifiedModel> from_off, double off) {
    constexpr double kAsMuch = 1.05, kNoMore = 1;  // relative to the residual of the other model
    const double max = start == ColdStart::plain ? kAsMuch : kNoMore;
    const bool as_well = from_off && (estimated ? share_left_by(*from_off) <= max * share_left_by(*estimated)
                                                : start == ColdStart::plain);
    if (!estimated && !as_well) return estimated;
    const bool rivals = estimated && (!from_off || share_left_by(*estimated) <= kAsMuch * share_left_by(*from_off));
    if (rivals && knows_gain(*estimated) && (!as_well || agree(*estimated, *from_off))) return estimated;
    if (!as_well) {
        if (start == ColdStart::possible) return estimated;
        return warned(std::move(*estimated), "No model explains y with u = " + text(off) + ", off, before it.",
                      WarningLevel::bad);
    }
    if (rivals && same_sign(*estimated, *from_off)) from_off->alternatives.push_back(estimated->plant);
    return warned(std::move(*from_off), "It is assumed to be " + text(off) + ", off.", WarningLevel::warning);
}

}  // namespace tunewright
