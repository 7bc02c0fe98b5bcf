#include "engine/identification/closed_loop/outside_excitation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "engine/identification/record/series.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

/// True if r is y, as many controllers write it in manual: of this row or the previous one, perhaps rounded.
bool tracks(std::span<const double> r, std::span<const double> y) {
    constexpr double kLevelTolerance = 1e-3,
                     kMaxGrid = 0.1;  // of y's range: a larger step is a level of r, not rounding
    constexpr double kMaxMoves = 0.8,
                     kMinMovingShare = 0.1;  // of the moves of r; of the rows: a set point moves in fewer
    const double grid = quantisation_step(r), same = kLevelTolerance + (grid < kMaxGrid ? 0.5 * grid : 0);
    int moves = 0, tracking = 0;
    for (std::size_t i = 1; i < r.size(); ++i) {
        if (r[i] == r[i - 1]) continue;
        ++moves;
        tracking += std::min(std::abs(r[i] - y[i]), std::abs(r[i] - y[i - 1])) < same ? 1 : 0;
    }
    return moves > kMinMovingShare * static_cast<double>(r.size()) && tracking > kMaxMoves * moves;
}

/// True if u is a straight line over r, of the same row or the previous one, except for rounding.
bool commands(std::span<const double> r, std::span<const double> u) {
    constexpr double kMaxDeviationShare = 1e-3;  // of u's standard deviation
    const double spread = deviation(u), grid = quantisation_step(u);
    if (!(spread > 0) || !(deviation(r) > 0)) return false;
    const double max = std::max(kMaxDeviationShare * spread, grid < spread ? grid : 0.0);
    for (const std::size_t late : {0U, 1U}) {
        const auto from = r.first(r.size() - late), to = u.last(u.size() - late);
        const std::vector<double> left = residuals(straight_line(from, to), from, to);
        if (std::ranges::all_of(left, [&](double e) { return std::abs(e) <= max; })) return true;
    }
    return false;
}

/// In the dimensionless unit of y.
std::vector<double> scaled_at_samples(const HeldColumn& column, const CleanRecord& record) {
    std::vector<double> r = at_samples(column, record);
    for (double& value : r) value = (value - record.scale.y_origin) / record.scale.y_scale;
    return r;
}

/// The set point at the samples, built from its moves alone.
std::vector<double> steps_at_samples(const std::vector<OutsideMove>& moves, const CleanRecord& record) {
    std::vector<double> w(static_cast<std::size_t>(record.samples()), 0.0);
    for (const OutsideMove& move : moves) {
        const auto from = std::lower_bound(record.t.begin(), record.t.end(), move.time) - record.t.begin();
        for (auto i = static_cast<std::size_t>(from); i < w.size(); ++i) w[i] += move.size;
    }
    return w;
}

/// A step from the previous rest of y; a unit step if no set point is known.
std::vector<double> stepped_from(double y_before, const std::vector<double>& r, std::size_t from, std::size_t rows) {
    std::vector<double> w(rows, y_before);
    for (std::size_t i = from; i < rows; ++i) w[i] = r.empty() ? y_before + 1 : r[i];
    return w;
}

/// The mean of y's first rows if y is at rest there and moves far from it; else empty.
std::optional<double> rest_at_first_row(const CleanRecord& record, const std::vector<double>& r) {
    constexpr double kMinTravel = 0.5, kMinDeparture = 0.02;  // of y's range
    constexpr double kNoiseDeviations = 3;                    // standard deviations that noise may move y in the other
                                                              // direction
    constexpr std::size_t kFirstRows = 3;                     // rows that may all lie within the dead time
    const std::span<const double> y(record.y);
    if (y.size() < static_cast<std::size_t>(10 * kRestRows)) return std::nullopt;
    // If u is constant in the first rows they show rest: u has not been moved yet.
    const std::vector<double> u = input_at_samples(record);
    if (std::all_of(u.begin(), u.begin() + kRestRows, [&](double value) { return value == u.front(); }))
        return std::nullopt;
    const double first = mean(y.first(kFirstRows)), end = r.empty() ? mean(y.last(y.size() / 5)) : r.front();
    if (std::abs(end - first) < kMinTravel) return std::nullopt;
    const double sign = end > first ? 1 : -1,
                 max = kMinDeparture + kNoiseDeviations * noise_std(y) + quantisation_step(y);
    const auto back = [&](double value) { return sign * (value - y.front()) < -max; };
    return std::ranges::any_of(y, back) ? std::nullopt : std::optional(first);
}

}  // namespace

SetPoint set_point_of(const CleanRecord& record, const Record& as_given) {
    SetPoint out;
    out.column = held_column(as_given.t, as_given.r);
    out.at_samples = scaled_at_samples(out.column, record);
    out.on = switched_on(record, out.at_samples);
    if (out.at_samples.empty()) return out;
    const std::span<const double> r(out.at_samples), y(record.y);
    out.is_input = commands(r, input_at_samples(record));
    const std::size_t from = out.on ? static_cast<std::size_t>(out.on->row) : 0;
    if (out.is_input || tracks(r.subspan(from), y.subspan(from))) {
        out.at_samples.clear();
        out.on = switched_on(record, {});
    }
    for (std::size_t i = from + 1; i < out.at_samples.size() && !out.moves; ++i)
        out.moves = out.at_samples[i] != out.at_samples[i - 1];
    return out;
}

bool set_point_is_input(const CleanRecord& record, const Record& as_given) {
    const std::vector<double> r = scaled_at_samples(held_column(as_given.t, as_given.r), record);
    return !r.empty() && commands(r, input_at_samples(record));
}

std::vector<OutsideExcitation> outside_excitations(const CleanRecord& record, const SetPoint& set_point,
                                                   const std::vector<OutsideMove>& kicks) {
    const std::vector<double>& r = set_point.at_samples;
    const auto rows = static_cast<std::size_t>(record.samples());
    const std::optional<SwitchOn>& on = set_point.on;
    std::vector<OutsideExcitation> found;
    if (on) {
        const LoopExcitation kind = set_point.moves ? LoopExcitation::set_point : LoopExcitation::switched_on;
        found.push_back(
            {kind, stepped_from(on->y_before, r, static_cast<std::size_t>(on->row), rows), on->y_before, false});
    } else if (set_point.moves) {
        found.push_back({LoopExcitation::set_point, r, r.front(), false});
    }
    if (r.empty() || !set_point.moves) {
        if (!kicks.empty()) found.push_back({LoopExcitation::outside_moves, steps_at_samples(kicks, record), 0, false});
        if (!on && rest_at_first_row(record, r))
            found.push_back({LoopExcitation::switched_on, std::vector<double>(rows, 1.0), 0, true});
    }
    return found;
}

}  // namespace tunewright
