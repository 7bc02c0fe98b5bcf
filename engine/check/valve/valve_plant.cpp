#include "engine/check/valve/valve_plant.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

constexpr std::size_t kMaxFittedRows = 12000;  // the last ones
constexpr double kMinPeriods = 4;
constexpr double kBandFactors[] = {0.7, 0.8, 0.9, 1, 1.1, 1.25};  // the size of a verdict is that uncertain
constexpr double kJumpShares[] = {0, 0.33, 0.67, 1};              // of the band
constexpr double kShortestLag = 0.5, kLagRatio = 1.3;             // rows
constexpr double kLongestDelayShare = 0.4;                        // of the period
constexpr int kMaxDelays = 24;

std::vector<ValveModel> valves_about(double band) {
    std::vector<ValveModel> out;
    for (const auto kind : {ValveModel::Kind::he, ValveModel::Kind::kano})
        for (const double factor : kBandFactors)
            for (const double share : kJumpShares) {
                if (kind == ValveModel::Kind::kano && share == 0) continue;  // He's is the same
                out.push_back({kind, factor * band, share * factor * band});
            }
    return out;
}

std::vector<double> lag_of_first_order(const std::vector<double>& x, double lag) {
    const double a = std::exp(-1 / lag);
    std::vector<double> out(x.size());
    double state = 0;
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = state = a * state + (1 - a) * x[i];
    return out;
}

/// The best delay for a response of gain 1 and no delay, if it is better than `best`.
void try_delays(const std::vector<double>& x, const std::vector<double>& y, double lag, double period, double sign,
                ValvePlantFit& best) {
    const double longest = std::max(1.0, kLongestDelayShare * period);
    const int apart = std::max(1, int(std::ceil(longest / kMaxDelays)));
    const auto skip = std::size_t(period);
    for (int delay = 1; delay <= int(longest); delay += apart) {
        // x already answers in the row of its input; the response to the row before is one delay.
        const std::size_t from = skip + std::size_t(delay);
        double xx = 0, xy = 0, yy = 0;
        for (std::size_t i = from; i < y.size(); ++i) {
            const double in = x[i - std::size_t(delay)];
            xx += in * in;
            xy += in * y[i];
            yy += y[i] * y[i];
        }
        if (!(xx > 0 && yy > 0) || xy * sign <= 0) continue;
        const double square = 1 - xy * xy / (xx * yy);
        if (square < best.square) best = {best.valve, {xy / xx, lag, delay}, square};
    }
}

}  // namespace

std::vector<double> without_drift(std::span<const double> values, double period) {
    const std::size_t n = values.size(), half = std::max<std::size_t>(1, std::size_t(std::lround(0.5 * period)));
    std::vector<double> sum(n + 1, 0.0), out(n);
    std::partial_sum(values.begin(), values.end(), sum.begin() + 1);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t reach = std::min({half, i, n - 1 - i}), from = i - reach, to = i + reach + 1;
        out[i] = values[i] - (sum[to] - sum[from]) / double(to - from);
    }
    return out;
}

std::vector<ValvePlantFit> fit_valve_plants(std::span<const double> output, std::span<const double> measurement,
                                            double band, double period, double longest_lag, double sign) {
    const std::size_t n = std::min({output.size(), measurement.size(), kMaxFittedRows});
    if (!(period >= 4) || double(n) < kMinPeriods * period) return {};
    const auto u = output.last(n);
    const std::vector<double> y = without_drift(measurement.last(n), period);
    std::vector<ValvePlantFit> fits;
    for (const ValveModel& valve : valves_about(band)) {
        std::vector<double> position = valve_position(u, valve);
        const double centre = mean(position);
        for (double& value : position) value -= centre;
        for (double lag = kShortestLag; lag < longest_lag; lag *= kLagRatio) {
            ValvePlantFit best{valve, {}, 1};
            try_delays(without_drift(lag_of_first_order(position, lag), period), y, lag, period, sign, best);
            if (best.square < 1) fits.push_back(best);
        }
    }
    std::ranges::sort(fits, {}, &ValvePlantFit::square);
    return fits;
}

}  // namespace tunewright::check
