#include "engine/identification/two_point.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/identification/record/record_kind.h"
#include "engine/number_text.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

/// The time at which the moving average of y first passes `level`, coming from the side of `y0`.
double crossing(const CleanRecord& r, std::size_t first, std::size_t window, double y0, double level) {
    const double side = level > y0 ? 1 : -1;
    double before = y0, t_before = r.t[first];
    for (std::size_t i = first; i + window <= r.y.size(); ++i) {
        const double y = mean(std::span(r.y).subspan(i, window)), t = mean(std::span(r.t).subspan(i, window));
        if (side * (y - level) >= 0)
            return y == before ? t : t_before + (level - before) / (y - before) * (t - t_before);
        before = y, t_before = t;
    }
    return r.t.back();
}

Error refused(const std::string& why) {
    return {ErrorKind::not_identifiable, "identify/method", why + " Use method output_error, which needs neither."};
}

}  // namespace

Expected<TwoPointModel> two_point(const CleanRecord& r) {
    const InputLevels levels = input_levels(r);
    if (levels.moves() != 1) {
        return refused("The two-point construction needs a record with one step of u; this one has " +
                       std::to_string(levels.moves()) + " moves.");
    }
    const auto first = static_cast<std::size_t>(std::lower_bound(r.t.begin(), r.t.end(), levels.time[1]) - r.t.begin());
    const std::size_t after = r.y.size() - first, tenth = after / 10;
    constexpr std::size_t kMinTenth = 2;         // samples, for two means whose difference is not only noise
    constexpr double kMaxUnsettledShare = 0.05;  // of the response
    constexpr double kMinDivisor = 1e-300;       // keeps a division by a value near 0 finite
    if (tenth < kMinTenth) return refused("The two-point construction needs 20 samples after the step.");
    const std::span<const double> y(r.y);
    const double end = mean(y.last(tenth)), earlier = mean(y.subspan(r.y.size() - 2 * tenth, tenth));
    const double y0 = r.y_rest ? *r.y_rest : first > 0 ? mean(y.first(first)) : y.front();
    if (std::abs(end - earlier) > kMaxUnsettledShare * std::abs(end - y0)) {
        return refused("y has not settled: in the last tenth of the record it still changes by " +
                       text(100 * std::abs(end - earlier) / std::max(kMinDivisor, std::abs(end - y0)), 2) +
                       " % of the response.");
    }
    const std::size_t window = std::max<std::size_t>(1, after / 200);
    const double t28 = crossing(r, first, window, y0, y0 + 0.283 * (end - y0)) - levels.time[1];
    const double t63 = crossing(r, first, window, y0, y0 + 0.632 * (end - y0)) - levels.time[1];
    if (!(t63 > t28)) return refused("y passes 28 % and 63 % of its response at the same time: record faster.");
    const double T = 1.5 * (t63 - t28), L = std::max(0.0, t63 - T);
    return TwoPointModel{{Structure::fopdt, {L, std::log(T), 0, 0}}, (end - y0) / (levels.level[1] - levels.level[0])};
}

}  // namespace tunewright
