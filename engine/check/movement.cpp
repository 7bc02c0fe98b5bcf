#include "engine/check/movement.h"

#include <algorithm>
#include <cmath>

#include "engine/check/harris.h"
#include "engine/check/thresholds.h"
#include "engine/identification/record/series.h"
#include "engine/numerics/fourier.h"
#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

constexpr double kHour = 3600;  // s
constexpr std::size_t kMostHarrisSamples = 20000;
constexpr int kDelayPlaces = 8;   // delays from the shortest to the longest
constexpr double kLeastMove = 3;  // of the noise: a smaller move of the set point shows no response

/// The longest dead time that the error's own correlation admits: a loop undoes a disturbance soon after its dead time,
/// and with it the correlation falls to 0.
int longest_delay(std::span<const double> error) {
    const auto most = std::max<std::size_t>(2, error.size() / 20);
    const auto r = autocorrelation(error, most);
    for (std::size_t k = 1; k < r.size(); ++k)
        if (r[k] <= 0) return std::max(2, static_cast<int>(k));
    return static_cast<int>(most);
}

OrReason<HarrisRange> harris_range(const Samples& samples, const LoopQuestion& question) {
    if (question.averaging.value_or(question.kind == LoopKind::level))
        return {std::nullopt, question.averaging
                                  ? "The level is there to smooth the flow: its variance is its purpose."
                                  : "A level may be there to smooth flows. Give averaging false if it must be held."};
    if (samples.size() < kFewestRows) return {std::nullopt, "The record is too short."};
    const auto error = samples.error();
    if (!(deviation(error) > 0)) return {std::nullopt, "The error is constant."};
    const std::span<const double> last = std::span(error).last(std::min(error.size(), kMostHarrisSamples));
    std::vector<int> delays;
    const int longest = longest_delay(last);
    for (int k = 0; k < kDelayPlaces; ++k) {
        const int delay = static_cast<int>(std::lround(std::pow(longest, double(k) / (kDelayPlaces - 1))));
        if (delays.empty() || delay > delays.back()) delays.push_back(delay);
    }
    const auto index = harris_index(last, delays);
    return HarrisRange{index.low, index.high, {samples.step * delays.front(), samples.step * delays.back()}};
}

/// All moves of the output, and their turns.
void add_output(PerformanceFigures& out, const Samples& samples, const LoopQuestion& question,
                const OutputRange& u_range) {
    double travel = 0, direction = 0;
    int turns = 0;
    for (std::size_t i = 1; i < samples.u.size(); ++i) {
        const double move = samples.u[i] - samples.u[i - 1];
        if (move == 0) continue;
        travel += std::abs(move);
        if (move * direction < 0) ++turns;
        direction = move;
    }
    const double hours = samples.duration() * question.seconds.value_or(0) / kHour;
    out.travel = out.reversals = no_figure(question.seconds ? "The record has no duration."
                                                            : "The unit of time is not known: give s, min, h or ms.");
    if (!(hours > 0)) return;
    out.reversals = turns / hours;
    out.travel = u_range.known ? Figure(travel / u_range.width() / hours)
                               : no_figure("The range of the output is not known: give it as range.op.");
}

/// (t+ - t-)/(t+ + t-) over the moves of block means, t+ where output and measurement move together (Hägglund 1999,
/// Control Engineering Practice 7, 1505). The sign of the plant's gain is that of the moves' correlation over a lag.
Figure idle_index(const Samples& samples) {
    const double noise = noise_std(samples.y), spread = deviation(samples.y);
    if (!(spread > 0) || !(deviation(samples.u) > 0)) return no_figure("Output or measurement is constant.");
    const auto count = static_cast<std::size_t>(std::clamp(2 * std::pow(noise / spread, 2) * 10, 1.0, 50.0));
    const auto y = block_means(samples.y, count), u = block_means(samples.u, count);
    if (y.size() < kFewestRows / 4) return no_figure("The measurement is mostly noise.");
    // In a loop the output falls when the measurement rises, for a plant of positive gain.
    const auto e = crosscorrelation(u, y, std::min<std::size_t>(y.size() / 4, 50));
    const double sign = *std::ranges::max_element(e, {}, [](double c) { return std::abs(c); }) < 0 ? 1 : -1;
    std::size_t with = 0, against = 0;
    for (std::size_t i = 1; i < y.size(); ++i) {
        const double product = sign * (u[i] - u[i - 1]) * (y[i] - y[i - 1]);
        with += product > 0 ? 1 : 0;
        against += product < 0 ? 1 : 0;
    }
    if (with + against == 0) return no_figure("Output and measurement never move together.");
    return (double(with) - double(against)) / double(with + against);
}

Figure following(const Samples& samples, const std::vector<double>& error) {
    if (samples.r.empty()) return no_figure("The record has no set point.");
    const double spread = deviation(samples.r);
    if (!(spread > kLeastMove * noise_std(samples.y))) return no_figure("The set point hardly moves.");
    const double e = deviation(error);
    return e * e / (spread * spread);
}

}  // namespace

PerformanceFigures no_performance(const std::string& why) {
    PerformanceFigures out;
    out.harris = {std::nullopt, why};
    out.idle_index = out.variability_share = out.following = out.travel = out.reversals = no_figure(why);
    return out;
}

PerformanceFigures performance_of(const Samples& samples, const OutputRange& u_range, const LoopQuestion& question) {
    PerformanceFigures out;
    const auto error = samples.error();
    out.variability = deviation(error);
    out.variability_share = question.y_range
                                ? Figure(out.variability / ((*question.y_range)[1] - (*question.y_range)[0]))
                                : no_figure("The range of the measurement is not given.");
    double sum = 0;
    for (const double e : error) sum += std::abs(e);
    out.mean_error = sum / static_cast<double>(error.size());
    const double offset = mean(error);
    std::vector<double> centred(error);
    for (double& e : centred) e -= offset;
    out.offset = offset;
    out.independent = effective_samples(centred);
    add_output(out, samples, question, u_range);
    out.harris = harris_range(samples, question);
    out.idle_index = idle_index(samples);
    out.following = following(samples, error);
    return out;
}

}  // namespace tunewright::check
