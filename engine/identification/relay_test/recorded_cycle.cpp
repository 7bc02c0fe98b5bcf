#include "engine/identification/relay_test/recorded_cycle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "engine/identification/record/record_kind.h"
#include "engine/identification/record/series.h"
#include "engine/number_text.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

/// y as a polyline and v as a staircase, integrated against e^(-st).
class Signals {
public:
    explicit Signals(const CleanRecord& record) : r_(record) {}

    double y_at(double t) const {
        const auto after = std::upper_bound(r_.t.begin(), r_.t.end(), t);
        if (after == r_.t.begin()) return r_.y.front();
        if (after == r_.t.end()) return r_.y.back();
        const std::size_t i = static_cast<std::size_t>(after - r_.t.begin());
        const double part = (t - r_.t[i - 1]) / (r_.t[i] - r_.t[i - 1]);
        return r_.y[i - 1] + part * (r_.y[i] - r_.y[i - 1]);
    }

    /// The integral of (y - y0 - slope (t - from)) e^(-st) over [from, to] by trapezoids.
    Complex of_y(double from, double to, Complex s, double y0, double slope) const {
        // e^(-s(t - from)) from sample to sample; evenly spaced samples share their factor.
        constexpr double kStepTolerance = 1e-15;  // of the record: rounding of evenly spaced times
        Complex turned = 1, factor = 1;
        double factor_of = 0, last = from;
        auto value = [&](double t, double y) {
            if (std::abs(t - last - factor_of) > kStepTolerance)
                factor_of = t - last, factor = std::exp(-s * factor_of);
            turned *= factor;
            return (y - y0 - slope * (t - from)) * turned;
        };
        Complex sum = 0, before = value(from, y_at(from));
        auto add = [&](double t, double y) {
            const Complex now = value(t, y);
            sum += 0.5 * (t - last) * (before + now);
            last = t;
            before = now;
        };
        for (auto i = std::upper_bound(r_.t.begin(), r_.t.end(), from) - r_.t.begin();
             i < static_cast<std::ptrdiff_t>(r_.t.size()) && r_.t[static_cast<std::size_t>(i)] < to; ++i)
            add(r_.t[static_cast<std::size_t>(i)], r_.y[static_cast<std::size_t>(i)]);
        add(to, y_at(to));
        return sum;
    }

    /// The integral of (v - v0) e^(-st) over [from, to], exactly.
    Complex of_v(double from, double to, Complex s, double v0) const {
        constexpr double kMinPhase = 1e-8;  // for a smaller phase (1 - e^(-sh))/s loses more digits than the error of h
        Complex sum = 0;
        auto piece = [&](double a, double b, double v) {
            const double h = b - a;
            const Complex whole = std::abs(s) * h < kMinPhase ? Complex(h) : (1.0 - std::exp(-s * h)) / s;
            sum += (v - v0) * std::exp(-s * (a - from)) * whole;
        };
        auto j = std::upper_bound(r_.v_time.begin(), r_.v_time.end(), from) - r_.v_time.begin();
        double now = from, v = j > 0 ? r_.v_level[static_cast<std::size_t>(j - 1)] : 0;
        for (; j < r_.changes() && r_.v_time[static_cast<std::size_t>(j)] < to; ++j) {
            piece(now, r_.v_time[static_cast<std::size_t>(j)], v);
            now = r_.v_time[static_cast<std::size_t>(j)];
            v = r_.v_level[static_cast<std::size_t>(j)];
        }
        piece(now, to, v);
        return sum;
    }

    struct Range {
        double low, high;
    };
    Range range(double from, double to) const {
        Range range{y_at(from), y_at(from)};
        for (auto i = std::lower_bound(r_.t.begin(), r_.t.end(), from) - r_.t.begin();
             i < static_cast<std::ptrdiff_t>(r_.t.size()) && r_.t[static_cast<std::size_t>(i)] <= to; ++i) {
            range.low = std::min(range.low, r_.y[static_cast<std::size_t>(i)]);
            range.high = std::max(range.high, r_.y[static_cast<std::size_t>(i)]);
        }
        return range;
    }

    int samples(double from, double to) const {
        return static_cast<int>(std::lower_bound(r_.t.begin(), r_.t.end(), to) -
                                std::lower_bound(r_.t.begin(), r_.t.end(), from));
    }

private:
    const CleanRecord& r_;
};

/// A whole period between two switches of the same direction.
struct Period {
    double from, to, mean, half;
};

std::vector<Period> whole_periods(const Signals& signals, const std::vector<double>& switches) {
    std::vector<Period> periods;
    for (std::size_t k = switches.size(); k >= 3; k -= 2) {
        const double from = switches[k - 3], to = switches[k - 1];
        const auto [low, high] = signals.range(from, to);
        periods.push_back({from, to, signals.of_y(from, to, 0, 0, 0).real() / (to - from), 0.5 * (high - low)});
        if (k < 5) break;
    }
    std::reverse(periods.begin(), periods.end());
    return periods;
}

/// The first of the last periods that are equal: their length, mean and swing differ from those of the later half only
/// by sampling and noise. A steady drift of the mean does not exclude a period.
std::size_t first_steady(const std::vector<Period>& periods, double spacing, double noise, int samples_a_period) {
    const std::size_t n = periods.size(), later = n / 2;
    std::vector<double> lengths, halves, steps;
    for (std::size_t k = later; k < n; ++k) {
        lengths.push_back(periods[k].to - periods[k].from);
        halves.push_back(periods[k].half);
        if (k > 0) steps.push_back(periods[k].mean - periods[k - 1].mean);
    }
    const double length = mean(lengths), half = mean(halves), step = mean(steps);
    constexpr double kMaxSpacings = 1.5;                // the two ends of a period appear at the next sample
    constexpr double kNoiseDeviations = 4;              // standard deviations
    constexpr double kOfLength = 2e-3, kOfHalf = 0.01;  // best accuracy of a steady oscillation
    const double length_tolerance = kMaxSpacings * spacing + kNoiseDeviations * deviation(lengths) + kOfLength * length;
    const double half_tolerance = kOfHalf * half + 2 * noise + kNoiseDeviations * deviation(halves);
    const double step_tolerance = kOfHalf * half + kNoiseDeviations * noise / std::sqrt(std::max(1, samples_a_period)) +
                                  kNoiseDeviations * deviation(steps) + std::abs(step) + spacing / length * half;
    std::size_t first = n - 1;
    for (std::size_t k = n; k-- > 0;) {
        const Period& p = periods[k];
        const bool repeats = std::abs(p.to - p.from - length) <= length_tolerance &&
                             std::abs(p.half - half) <= half_tolerance &&
                             (k + 1 == n || std::abs(periods[k + 1].mean - p.mean - step) <= step_tolerance);
        if (!repeats && k < later) break;
        first = k;
    }
    return first;
}

/// The drift of the mean of y from period to period; for at least three periods.
Line creep(const std::vector<Period>& periods, std::size_t first) {
    if (periods.size() - first < 3) return {};
    std::vector<double> middles, means;
    for (std::size_t k = first; k < periods.size(); ++k) {
        middles.push_back(0.5 * (periods[k].from + periods[k].to));
        means.push_back(periods[k].mean);
    }
    return straight_line(middles, means);
}

/// Largest change of y that does not count as movement: standard deviations of its noise, and a share of its swing.
constexpr double kNoiseDeviations = 4, kOfSwing = 0.002;

/// The mean of y before the plant responds: up to the relay's start; or, if the record starts with it, over the earlier
/// half of the first samples until one leaves their mean (with noise a response is visible only some time after its
/// beginning).
double y_before_answer(const CleanRecord& r, double relay_start, double noise, double swing, int& n) {
    double sum = 0;
    n = 0;
    const bool before = relay_start > 0;
    std::vector<double> sums;
    for (int i = 0; i < r.samples(); ++i) {
        const double y = r.y[static_cast<std::size_t>(i)], t = r.t[static_cast<std::size_t>(i)];
        const bool answered =
            before ? t > relay_start : n > 0 && std::abs(y - sum / n) > kNoiseDeviations * noise + kOfSwing * swing;
        if (answered && n > 0) break;
        sum += y;
        sums.push_back(sum);
        ++n;
    }
    if (!before) n = (n + 1) / 2;
    return sums[static_cast<std::size_t>(n - 1)] / n;
}

RestPoint rest_point(const CleanRecord& r, const TwoLevels& u, double relay_start, double noise, double swing) {
    RestPoint rest;
    int n = 0;
    rest.y = r.y_rest ? *r.y_rest : y_before_answer(r, relay_start, noise, swing, n);
    if (relay_start > 0 || r.u0_given) return rest;
    // Deviations are recorded around 0; otherwise the middle of the levels is the only information.
    rest.assumed = true;
    const double zero = -r.scale.u_rest / r.scale.u_scale, y_zero = -r.scale.y_origin / r.scale.y_scale;
    const bool deviations = zero > u.low && zero < u.high;
    rest.v = deviations ? zero : 0.5 * (u.low + u.high);
    if (deviations && !r.y_rest &&
        std::abs(rest.y - y_zero) < kNoiseDeviations * noise / std::sqrt(n) + kOfSwing * swing)
        rest.y = y_zero;
    return rest;
}

/// Standard deviation of the mean of y over the rows at rest; n of them are before the relay's start.
double rest_std(const CleanRecord& r, double relay_start, double noise) {
    constexpr double kGivenRows = 10;          // number of rows that a given level of rest counts as
    constexpr double kMinDitherInGrids = 0.3;  // of a step of y's grid: with less noise all rows have the same error
    if (r.y_rest) return noise / std::sqrt(kGivenRows);
    const auto after = std::upper_bound(r.t.begin(), r.t.end(), relay_start);
    const std::span rest(r.y.data(), static_cast<std::size_t>(after - r.t.begin()));
    const double rounding = quantisation_step(r.y) / std::sqrt(12.0);
    if (relay_start <= 0 || rest.size() < 2) return std::hypot(noise, rounding);
    const double scatter = deviation(rest);
    const auto n = static_cast<double>(rest.size());
    if (scatter < kMinDitherInGrids * rounding * std::sqrt(12.0)) return std::max(rounding, scatter);
    return std::max(noise / std::sqrt(n), scatter * std::sqrt(std::min(1.0, correlation_time(rest) / n)));
}

/// As RecordedCycle::mean_std.
double mean_std(const CleanRecord& r, const std::vector<Period>& periods, const RecordedCycle& cycle, double noise) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < periods.size(); ++k)
        if (periods[k - 1].from >= cycle.start) steps.push_back(periods[k].mean - periods[k - 1].mean);
    const double away = (cycle.start - 0.5 * cycle.relay_start) / cycle.period + 0.5 * cycle.periods;
    const double creep = steps.empty() ? 0 : mean(steps) * away;
    const double walk = steps.size() < 2 ? 0 : deviation(steps) * std::sqrt(away);
    return std::hypot(rest_std(r, cycle.relay_start, noise), creep, walk);
}

/// Whole periods from `start` on, and the scatter of their responses.
struct Pooled {
    Complex U, Y;
    double scatter = 0;  ///< standard deviation of Y's parts
};

Pooled pool(const Signals& signals, const RecordedCycle& cycle, int order) {
    const Complex s(0, order * cycle.omega());
    const double n = cycle.periods;
    Pooled pooled;
    std::vector<Complex> U, Y;
    for (int p = 0; p < cycle.periods; ++p) {
        const double from = cycle.start + p * cycle.period, to = from + cycle.period;
        const double level = cycle.y_start() + cycle.drift * (from - cycle.start);
        U.push_back(signals.of_v(from, to, s, cycle.v_mean) / cycle.period);
        Y.push_back(signals.of_y(from, to, s, level, cycle.drift) / cycle.period);
        pooled.U += U.back() / n;
        pooled.Y += Y.back() / n;
    }
    const Complex G = pooled.Y / pooled.U;
    double squares = 0;
    for (std::size_t p = 0; p < U.size(); ++p) squares += std::norm(Y[p] - G * U[p]);
    pooled.scatter = n > 1 ? std::sqrt(squares / (2 * n * (n - 1))) : 0;
    return pooled;
}

void add_harmonics(const Signals& signals, double noise, RecordedCycle& cycle) {
    constexpr int kHighest = 25, kSamplesAWave = 8;  // order; with fewer samples a harmonic is not visible
    const int samples = signals.samples(cycle.start, cycle.start + cycle.period * cycle.periods);
    const double by_noise = noise / std::sqrt(2.0 * std::max(1, samples));
    for (int k = 1; k <= kHighest && k * kSamplesAWave * cycle.periods <= samples; ++k) {
        const Pooled pooled = pool(signals, cycle, k);
        cycle.harmonics.push_back(
            {k, pooled.U, pooled.Y, pooled.Y / pooled.U, std::max(pooled.scatter, by_noise) / std::abs(pooled.U)});
    }
}

/// Period, means and creep of the periods from `first` on.
void take_periods(const Signals& signals, const std::vector<Period>& periods, std::size_t first, RecordedCycle& cycle) {
    cycle.periods = static_cast<int>(periods.size() - first);
    cycle.start = periods[first].from;
    cycle.period = (periods.back().to - cycle.start) / cycle.periods;
    const Line line = creep(periods, first);
    const double length = cycle.period * cycle.periods;
    std::vector<double> lengths, halves;
    for (std::size_t k = first; k < periods.size(); ++k) {
        lengths.push_back(periods[k].to - periods[k].from);
        halves.push_back(periods[k].half);
    }
    cycle.period_scatter = deviation(lengths);
    cycle.y_half = mean(halves);
    constexpr int kMinPeriods = 4;
    constexpr double kSlopeErrors = 6, kMinVisibleDrift = 0.01;  // standard errors; of half a swing over all periods
    const bool creeps = cycle.periods >= kMinPeriods && std::abs(line.slope) > kSlopeErrors * line.slope_std &&
                        std::abs(line.slope) * length > kMinVisibleDrift * cycle.y_half;
    cycle.drift = creeps ? line.slope : 0;
    cycle.v_mean = signals.of_v(cycle.start, cycle.start + length, 0, 0).real() / length;
    cycle.y_mean = signals.of_y(cycle.start, cycle.start + length, 0, 0, 0).real() / length;
}

/// Takes that number of the equal periods which makes the pooled response most accurate: an additional period averages
/// noise, but one that is not yet steady adds scatter.
void take_best_periods(const Signals& signals, const std::vector<Period>& periods, std::size_t steady, double noise,
                       RecordedCycle& cycle) {
    constexpr double kMaxShareOfOther = 0.7;
    double min = std::numeric_limits<double>::max();
    RecordedCycle best;
    for (std::size_t first = steady; first + 2 <= periods.size(); ++first) {
        RecordedCycle now = cycle;
        take_periods(signals, periods, first, now);
        const int samples = signals.samples(now.start, now.start + now.period * now.periods);
        const double n = now.periods, by_noise = noise / std::sqrt(2.0 * std::max(1, samples));
        const double uncertainty = std::max(pool(signals, now, 1).scatter, by_noise) * (1 + 1 / (n - 1));
        // Fewer periods are used only if they are clearly more accurate, because the scatter of a few is itself
        // uncertain.
        if (uncertainty < kMaxShareOfOther * min) min = uncertainty, best = now;
    }
    if (best.periods > 0)
        cycle = best;
    else
        take_periods(signals, periods, steady, cycle);
}

}  // namespace

bool RecordedCycle::biased() const {
    constexpr double kMinBias = 0.05;  // of half a swing: accuracy of a level of rest
    return std::abs(v_middle - rest.v) > kMinBias * v_half;
}

double RecordedCycle::static_gain_std() const { return mean_std / std::abs(v_mean - rest.v); }

double RecordedCycle::static_gain() const { return (y_mean - rest.y) / (v_mean - rest.v); }

Expected<RecordedCycle> find_cycle(const CleanRecord& r, double noise) {
    const InputLevels levels = input_levels(r);
    const TwoLevels u = two_levels(levels);
    const std::size_t switches = u.switch_time.size();
    if (switches < 2) {
        return Error{
            ErrorKind::not_identifiable, "record/u",
            "u does not switch between two levels (" + std::to_string(switches) +
                " switches found), so there is no limit cycle. Use method output_error, or record a relay test."};
    }
    const Signals signals(r);
    const std::vector<Period> periods = whole_periods(signals, u.switch_time);
    if (periods.size() < 2) {
        return Error{
            ErrorKind::not_identifiable, "record",
            "The record holds " + text(0.5 * static_cast<double>(switches - 1), 2) +
                " cycles of the relay's oscillation (" + std::to_string(switches) +
                " switches); the limit-cycle formulas need two whole ones, and four or more are better. Record "
                "longer, or use method output_error."};
    }
    RecordedCycle cycle;
    const double relay_level = u.first_is_up ? u.low : u.high;
    constexpr double kLevelTolerance = 0.02;  // of the distance between the levels
    const bool pre_test =
        std::abs(levels.level.front() - relay_level) > kLevelTolerance * (u.high - u.low) && levels.moves() > 0;
    cycle.relay_start = pre_test ? levels.time[1] : 0;
    cycle.recorded_periods = static_cast<int>(periods.size());
    const double spacing = r.t.back() / std::max(1, r.samples() - 1);
    const double typical = periods.back().to - periods.back().from;
    const std::size_t first = first_steady(periods, spacing, noise, static_cast<int>(typical / spacing));
    take_best_periods(signals, periods, first, noise, cycle);
    cycle.v_middle = 0.5 * (u.high + u.low);
    cycle.v_half = 0.5 * (u.high - u.low);
    cycle.rest = rest_point(r, u, cycle.relay_start, noise, cycle.y_half);
    cycle.mean_std = mean_std(r, periods, cycle, noise);
    add_harmonics(signals, noise, cycle);
    if (cycle.harmonics.empty()) {
        return Error{
            ErrorKind::not_identifiable, "record",
            "The oscillation is sampled fewer than 8 times per period, so the times of the switches, and the gain, are "
            "inaccurate. Record faster."};
    }
    // Without reversal, the first harmonic lags by about half a turn.
    const double phase = std::arg(cycle.harmonics.front().G);
    cycle.reversed = std::abs(phase) < 0.5 * std::numbers::pi;
    return cycle;
}

Complex shifted_response(const CleanRecord& r, const RecordedCycle& cycle, double sigma) {
    const Signals signals(r);
    const Complex s(sigma, cycle.omega());
    const double length = cycle.period * cycle.periods, lead = cycle.start - cycle.relay_start;
    const Complex carry = std::exp(-s * lead), fold = 1.0 - std::exp(-s * length);
    const Complex y = signals.of_y(cycle.relay_start, cycle.start, s, cycle.rest.y, 0) +
                      carry * signals.of_y(cycle.start, cycle.start + length, s, cycle.rest.y, 0) / fold;
    const Complex v = signals.of_v(cycle.relay_start, cycle.start, s, cycle.rest.v) +
                      carry * signals.of_v(cycle.start, cycle.start + length, s, cycle.rest.v) / fold;
    return y / v;
}

}  // namespace tunewright
