#include "engine/check/valve/cycle_stops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "engine/check/samples.h"
#include "engine/check/thresholds.h"
#include "engine/check/valve/valve_plant.h"
#include "engine/number_text.h"
#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// A cycle does not tell a lag of many of its periods from an integrating plant, which only a level is taken to be.
constexpr double kLongestLag = 2, kLongestLevelLag = 30;  // periods

// The simulated cycle is the recorded one.
constexpr double kPeriodTolerance = 0.3, kAmplitudeTolerance = 0.5;
constexpr double kMaxResidual = 0.6;      // of the measurement's square: beyond it the fit shows little
constexpr double kMaxSquare = 1.3;        // of the nearest plant that makes the cycle: others count too
constexpr int kBuildUp = 15, kSeen = 15;  // periods until the cycle is steady, and in which it is measured

constexpr double kOtherLag = 0.6, kMaxDistance = 1;  // in ln; beyond the nearest model's distance

// The output rests.
constexpr double kRestOfBand = 0.01;
constexpr double kRunTimes = 30;  // of the slowest of period, Ti and lag
constexpr double kMaxRunRows = 100000;
constexpr std::array<double, 4> kLoads = {1, -1, 0.5, 0};  // bands, one in each phase of the cycle

// The search.
constexpr double kGains[] = {1, 0.7, 0.5, 0.35, 0.25, 0.17, 0.12};       // of today's
constexpr double kIntegralTimes[] = {1, 1.5, 2, 3, 4.5, 7, 10, 14, 20};  // of today's
constexpr double kGainMargin = 1.4;
constexpr double kGapRatio = 1.2, kLeastGap = 0.05, kMostGap = 3;  // of the amplitude

struct Cycle {
    double period = 0, amplitude = 0;  // rows; sqrt 2 times the standard deviation
};

struct LoopModel {
    ValveModel valve;
    RowPlant plant;
    Cycle cycle;
    double square = 0;              ///< ValvePlantFit::square
    double distance = 0;            ///< from the record
    std::vector<ValveLoop> phases;  ///< in the cycle, with today's law
};

Cycle cycle_of(const std::vector<double>& y) {
    const double centre = mean(y);
    double first = -1, last = -1;
    int crossings = 0;
    for (std::size_t i = 1; i < y.size(); ++i) {
        if (!(y[i - 1] < centre && y[i] >= centre)) continue;
        last = double(i);
        if (crossings++ == 0) first = last;
    }
    return crossings < 3 ? Cycle{} : Cycle{(last - first) / (crossings - 1), std::sqrt(2.0) * deviation(y)};
}

LoopModel model_of(const ValvePlantFit& fit, const PiLaw& today, double period) {
    LoopModel model{.valve = fit.valve, .plant = fit.plant, .cycle = {}, .phases = {}};
    ValveLoop loop(fit.valve, fit.plant, today);
    const auto rows = [&](double periods) { return std::size_t(periods * period); };
    for (std::size_t i = 0; i < rows(kBuildUp); ++i) loop.advance(fit.valve.band);
    std::vector<double> y;
    for (std::size_t i = 0; i < rows(kSeen); ++i) {
        loop.advance(fit.valve.band);
        y.push_back(loop.y());
    }
    model.cycle = cycle_of(y);
    for (std::size_t k = 0; k < kLoads.size(); ++k) {
        model.phases.push_back(loop);
        for (std::size_t i = 0; i < rows(1.0 / double(kLoads.size())); ++i) loop.advance(fit.valve.band);
    }
    return model;
}

/// A cycle shows the product of plant gain and jump well, but hardly each of them: of each kind of valve and share of
/// the jump in the band one model stays, the nearest first.
void keep_best_of_each_jump(std::vector<LoopModel>& models) {
    std::ranges::sort(models, {}, &LoopModel::distance);
    std::vector<LoopModel> kept;
    const double limit = models.empty() ? 0 : models.front().distance + kMaxDistance;
    for (LoopModel& model : models) {
        const bool known = std::ranges::any_of(kept, [&](const LoopModel& other) {
            return other.valve.kind == model.valve.kind &&
                   std::abs(other.valve.jump / other.valve.band - model.valve.jump / model.valve.band) < 0.1 &&
                   std::abs(std::log(other.plant.lag / model.plant.lag)) < kOtherLag;
        });
        if (!known && model.distance <= limit) kept.push_back(std::move(model));
    }
    models = std::move(kept);
}

class Search {
public:
    Search(std::vector<LoopModel> models, const PiLaw& today, double rest, const std::stop_token& stop)
        : models_(std::move(models)), today_(today), rest_(rest), stop_(stop), best_(models_.front()) {
        for (const LoopModel& model : models_) todays_errors_.push_back(error_after_load(model, today_));
    }

    struct Found {
        PiLaw law;
        std::array<double, 2> error_ratio{kInfinite, 0};  // over the models
        double standing_error = 0;
    };

    std::optional<Found> longer_integral_time() const {
        return cheapest([&](double gain) { return first_that_stops(laws_of_times(gain)); });
    }
    std::optional<Found> gap() const {
        return cheapest([&](double gain) { return first_that_stops(laws_of_gaps(gain)); });
    }
    std::optional<Found> no_integral() const {
        return cheapest([&](double gain) { return first_that_stops({{gain, kInfinite, 0}}); });
    }

private:
    std::vector<PiLaw> laws_of_times(double gain) const {
        std::vector<PiLaw> laws;
        for (const double factor : kIntegralTimes)
            if (factor > 1 || gain != today_.Kp) laws.push_back({gain, factor * today_.Ti, 0});
        return laws;
    }

    /// From the smallest that can hold a jump of the valve, half of it to either side.
    std::vector<PiLaw> laws_of_gaps(double gain) const {
        std::vector<PiLaw> laws;
        const double amplitude = best_.cycle.amplitude;
        const double least = std::max(0.5 * std::abs(best_.plant.K) * best_.valve.jump, kLeastGap * amplitude);
        for (double gap = least; gap <= std::max(kMostGap * amplitude, 2 * least); gap *= kGapRatio)
            laws.push_back({gain, today_.Ti, gap});
        return laws;
    }

    /// The first law that stops the cycle, also with kGainMargin times the plant's gain.
    std::optional<Found> first_that_stops(const std::vector<PiLaw>& laws) const {
        for (const PiLaw& law : laws) {
            if (stop_.stop_requested()) break;
            const auto standing = standing_error(law);
            if (standing && standing_error({kGainMargin * law.Kp, law.Ti, law.gap / kGainMargin}))
                return Found{law, error_ratios(law), *standing};
        }
        return std::nullopt;
    }

    std::optional<Found> cheapest(const std::function<std::optional<Found>(double)>& with_gain) const {
        std::optional<Found> best;
        for (const double factor : kGains) {
            const auto found = with_gain(factor * today_.Kp);
            if (found && std::isfinite(found->error_ratio[1]) &&
                (!best || found->error_ratio[1] < best->error_ratio[1]))
                best = found;
        }
        return best;
    }

    /// The largest error at rest; empty if an output does not come to rest.
    std::optional<double> standing_error(const PiLaw& law) const {
        double largest = 0;
        const std::size_t runs = models_.size() * kLoads.size();
        for (std::size_t i = 0; i < runs; ++i) {
            const std::size_t run = (hardest_ + i) % runs;
            const auto at_rest = error_at_rest(models_[run / kLoads.size()], run % kLoads.size(), law);
            if (!at_rest) {
                hardest_ = run;
                return std::nullopt;
            }
            largest = std::max(largest, *at_rest);
        }
        return largest;
    }

    std::optional<double> error_at_rest(const LoopModel& model, std::size_t phase, const PiLaw& law) const {
        ValveLoop loop = model.phases[phase];
        loop.take(law);
        const double load = (1 + kLoads[phase]) * model.valve.band;
        // Where the integral rests, the lag is that of the loop with the gain alone.
        const double lag = model.plant.lag / (1 + std::abs(model.plant.K * law.Kp));
        const double slowest = std::max({model.cycle.period, lag, std::isfinite(law.Ti) ? law.Ti : 0.0});
        const auto rows = std::size_t(std::min(kRunTimes * slowest, kMaxRunRows));
        for (std::size_t i = 0; i < rows * 2 / 3; ++i) loop.advance(load);
        double low = loop.u(), high = low, error = 0;
        for (std::size_t i = 0; i < rows / 3; ++i) {
            loop.advance(load);
            low = std::min(low, loop.u());
            high = std::max(high, loop.u());
            error = std::max(error, std::abs(loop.y()));
            if (!(high - low <= rest_)) return std::nullopt;
        }
        return error;
    }

    std::array<double, 2> error_ratios(const PiLaw& law) const {
        std::array<double, 2> ends{kInfinite, 0};
        for (std::size_t k = 0; k < models_.size(); ++k) {
            const double ratio = error_after_load(models_[k], law) / todays_errors_[k];
            ends = {std::min(ends[0], ratio), std::max(ends[1], ratio)};
        }
        return ends;
    }

    /// Sum of abs e after a step of the load, with a valve that moves as it should.
    double error_after_load(const LoopModel& model, const PiLaw& law) const {
        ValveLoop loop({}, model.plant, law);
        double sum = 0;
        for (std::size_t i = 0; i < std::size_t(kCostPeriods * best_.cycle.period); ++i) {
            loop.advance(best_.valve.band);
            sum += std::abs(loop.y());
        }
        return sum;
    }

    std::vector<LoopModel> models_;
    PiLaw today_;
    double rest_;
    const std::stop_token& stop_;
    const LoopModel& best_;
    std::vector<double> todays_errors_;
    mutable std::size_t hardest_ = 0;  // the run that refused the last law, and likely refuses the next
};

CycleStops not_told(const std::string& why) {
    CycleStops out;
    out.period = out.amplitude = no_figure(why);
    out.detail = "Whether other settings end the cycle cannot be told. " + why;
    return out;
}

std::string range_text(const std::array<double, 2>& ends) {
    const std::string low = figure_text(ends[0], 2), high = figure_text(ends[1], 2);
    return low == high ? low : low + " to " + high;
}

/// A sentence on one means.
std::string sentence_of(const CycleStop& stop, const UnitNames& units, double today_Kp) {
    std::string out;
    const std::string gain = "a gain of " + figure_text(stop.Kp);
    const bool same_gain = std::abs(stop.Kp / today_Kp - 1) < 1e-9;
    switch (stop.means) {
        case StopMeans::integral_time:
            out = "With " + (same_gain ? "" : gain + " and ") + "Ti " + units.time_text(*stop.Ti);
            break;
        case StopMeans::gap:
            out = "With " + (same_gain ? "" : gain + " and ") +
                  "a gap on the error, integral action resting while the error is at most " + units.y_text(stop.gap) +
                  ",";
            break;
        case StopMeans::no_integral: out = "Without integral action" + (same_gain ? "" : " and with " + gain); break;
    }
    out += " the cycle ends; after a step of the load the mean error is " + range_text(stop.error_ratio) +
           " times that of today's settings with a good valve";
    if (stop.means == StopMeans::integral_time) return out + ".";
    return out + ", and an error of up to " + units.y_text(stop.standing_error) + " remains.";
}

/// Why the question cannot be asked; "" if it can.
std::string missing_in(const LoopCheck& check) {
    const LoopLaw& law = check.law;
    if (!check.cause.size) return "The size of its dead band is not known.";
    if (!check.cause.period) return "The valve moves too seldom for a period.";
    if (!(law.explained >= kKnownLaw)) return "The record does not show today's settings; give them as controller.";
    if (!(std::isfinite(law.Ti) && law.Ti > 0)) return "Today's settings have no integral action.";
    return "";
}

/// `recorded`: the cycle of the record.
std::vector<LoopModel> models_that_make(const Cycle& recorded, const std::vector<ValvePlantFit>& fits,
                                        const PiLaw& today, const std::stop_token& stop) {
    std::vector<LoopModel> models;
    for (const ValvePlantFit& fit : fits) {
        const double best = models.empty() ? fit.square : models.front().square;
        if (stop.stop_requested() || fit.square > std::min(kMaxSquare * best, kMaxResidual)) break;
        LoopModel model = model_of(fit, today, recorded.period);
        const double of_period = std::abs(model.cycle.period / recorded.period - 1) / kPeriodTolerance,
                     of_amplitude = std::abs(model.cycle.amplitude / recorded.amplitude - 1) / kAmplitudeTolerance;
        if (!(of_period <= 1 && of_amplitude <= 1)) continue;
        model.square = fit.square;
        model.distance = of_period + of_amplitude + (fit.square / best - 1) / (kMaxSquare - 1);
        models.push_back(std::move(model));
    }
    keep_best_of_each_jump(models);
    return models;
}

void add_stop(CycleStops& out, StopMeans means, const std::optional<Search::Found>& found, double step,
              const LoopCheck& check) {
    if (!found) return;
    CycleStop stop;
    stop.means = means;
    stop.Kp = found->law.Kp;
    if (std::isfinite(found->law.Ti)) stop.Ti = found->law.Ti * step;
    stop.gap = found->law.gap;
    stop.error_ratio = found->error_ratio;
    stop.standing_error = found->standing_error;
    stop.detail = sentence_of(stop, check.units, check.law.gain);
    out.stops.push_back(std::move(stop));
}

}  // namespace

CycleStops cycle_stops(const LoopQuestion& question, const LoopCheck& check, const std::stop_token& stop) {
    if (const std::string missing = missing_in(check); !missing.empty()) return not_told(missing);
    const Samples samples = even_samples(rows_of(question.record));
    const double step = samples.step, period = *check.cause.period / step;
    const PiLaw today{check.law.gain, check.law.Ti / step, 0};
    const double variance = std::pow(deviation(without_drift(samples.y, period)), 2) - std::pow(check.quality.noise, 2);
    const Cycle recorded{period, std::sqrt(2 * std::max(0.0, variance))};
    const double longest_lag = (question.kind == LoopKind::level ? kLongestLevelLag : kLongestLag) * period;
    const auto fits = fit_valve_plants(samples.u, samples.y, *check.cause.size, period, longest_lag, check.law.gain);
    auto models = models_that_make(recorded, fits, today, stop);
    if (models.empty())
        return not_told("The loop, simulated with its valve and the plant of the record, does not make this cycle.");
    const LoopModel& best = models.front();
    CycleStops out;
    out.recorded_amplitude = recorded.amplitude;
    out.period = best.cycle.period * step;
    out.amplitude = best.cycle.amplitude;
    out.plant = Fopdt{.K = best.plant.K, .T = best.plant.lag * step, .L = (best.plant.delay - 1) * step};
    const double rest = std::max(check.quality.u_step, kRestOfBand * best.valve.band);
    const Search search(std::move(models), today, rest, stop);
    add_stop(out, StopMeans::integral_time, search.longer_integral_time(), step, check);
    add_stop(out, StopMeans::gap, search.gap(), step, check);
    add_stop(out, StopMeans::no_integral, search.no_integral(), step, check);
    out.outcome = out.stops.empty() ? CycleStops::Outcome::none : CycleStops::Outcome::found;
    out.detail = out.stops.empty()
                     ? "No settings surely end the cycle: neither a longer integral time, nor a gap on the "
                       "error, nor no integral action, each with today's and with lower gains."
                     : "Until the valve is repaired, other settings end its cycle, and each has a cost.";
    return out;
}

}  // namespace tunewright::check
