#include "engine/check/valve/valve_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "engine/check/samples.h"
#include "engine/numerics/fourier.h"
#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::size_t kMostRows = 9000;
constexpr double kRowsPerPeriod = 60;  // at least, where rows are left out
constexpr double kBlocksPerPeriod = 12;
constexpr std::size_t kFewestBlocks = 160;
constexpr double kLeastRatio = 0.3, kMostRatio = 1.35;  // of a band to the output's range within a period
constexpr int kOwnLags = 6, kOutputLags = 3, kValveLags = 2;
constexpr double kLongestDelay = 0.35;  // of the period
constexpr int kFewestDelays = 3, kMostDelays = 8;
constexpr int kSegments = 10, kBestLeftOut = 2;
constexpr double kLineLike = 0.8;  // share of a single sine from which harmonics of it are regressors too
constexpr int kHarmonics = 5;
constexpr double kHighest = 0.45;                         // cycles per block
constexpr double kBelowPeriod = 0.3, kAbovePeriod = 2.5;  // of 1/period: the band in which its cycles are counted

// What a fit must reach. The gains are larger where other explanations are near: a regular oscillation is also a linear
// resonance, a line also a disturbance.
constexpr double kRegularHere = 10;
constexpr double kGain = 0.03, kGainOfRegular = 0.08, kGainOfLine = 0.25;
constexpr double kShareOfLine = 0.3;  // of what the harmonics explain
constexpr double kLeastB = -0.1, kLeastBOfLine = 0.05, kBothOfLine = 0.15;
constexpr double kBothGain = 0.08;  // A and B agree: fewer events suffice
constexpr double kStrength = 20, kBothStrength = 12;
constexpr double kPositive = 0.7, kPositiveOfStrong = 0.5, kStrongGain = 0.2;
constexpr double kWrongWay = -0.15, kBarely = 0.03, kBarelyB = 0.05, kClearGain = 0.3;
constexpr double kNearlyBoth = 0.1, kOneClear = 0.14, kNearlyWay = -0.05, kNearlyWayB = 0.025;
constexpr double kBandOfRange = 1.02, kBandOfRangeRegular = 1.2, kHardlyRegular = 5;

Vector centred(std::vector<double> values) {
    Vector out = Eigen::Map<const Vector>(values.data(), Eigen::Index(values.size()));
    out.array() -= out.mean();
    return out;
}

/// Column k: the series `lag_from + k` rows earlier, from row `skip` on.
Matrix lags(const Vector& series, Eigen::Index skip, int from, int count) {
    const Eigen::Index n = series.size() - skip;
    Matrix out(n, count);
    for (int k = 0; k < count; ++k) out.col(k) = series.segment(skip - from - k, n);
    return out;
}

/// A regression with one series of the valve or the output, for each delay.
struct SeriesFit {
    std::vector<double> squares;                                ///< residual's, by delay
    std::vector<Eigen::Matrix<double, kValveLags, 1>> weights;  ///< by delay
    std::size_t best() const { return std::size_t(std::ranges::min_element(squares) - squares.begin()); }
    double least() const { return std::ranges::min(squares); }
};

class Regression {
public:
    Regression(const Matrix& common, const Vector& y, int delays) : delays_(delays) {
        const Eigen::HouseholderQR<Matrix> qr(common);
        Q_ = qr.householderQ() * Matrix::Identity(common.rows(), common.cols());
        left_ = y - Q_ * (Q_.transpose() * y);
        total_ = left_.squaredNorm();
    }

    SeriesFit fit(const Matrix& X) const {
        const Matrix gram = X.transpose() * X, C = X.transpose() * Q_;
        const Matrix g = gram - C * C.transpose();
        const Vector b = X.transpose() * left_;
        SeriesFit out;
        for (int d = 0; d < delays_; ++d) {
            Eigen::Matrix2d A = g.block<kValveLags, kValveLags>(d, d);
            for (int i = 0; i < kValveLags; ++i) A(i, i) += 1e-7 * gram(d + i, d + i) + 1e-12;
            const Eigen::Vector2d rhs = b.segment<kValveLags>(d), x = A.inverse() * rhs;
            out.weights.push_back(x);
            out.squares.push_back(std::max(total_ - x.dot(rhs), 1e-9 * total_));
        }
        return out;
    }

    Vector residual(const Matrix& X, const SeriesFit& fit, std::size_t delay) const {
        const Matrix own = X.middleCols(Eigen::Index(delay), kValveLags);
        return left_ - (own - Q_ * (Q_.transpose() * own)) * fit.weights[delay];
    }

private:
    int delays_;
    Matrix Q_;
    Vector left_;
    double total_ = 0;
};

/// What the best valve explains more than the output, in one of the two regressions.
struct Comparison {
    double gain = 0, positive = 0;  ///< trimmed; share of the segments in which the valve is better
    double direction = 0;           ///< -1 to 1: the sign and agreement of the valve's weights
    std::size_t valve = 0;
    double linear = 0;            ///< least square with the output
    std::vector<double> squares;  ///< least square of each valve
};

void compare_segments(const Vector& with_output, const Vector& with_valve, Comparison& out) {
    const Eigen::Index n = with_output.size();
    std::vector<std::pair<double, double>> parts;  // gain, square with the valve
    for (int k = 0; k < kSegments; ++k) {
        const Eigen::Index from = n * k / kSegments, count = n * (k + 1) / kSegments - from;
        const double u = with_output.segment(from, count).squaredNorm(),
                     v = with_valve.segment(from, count).squaredNorm();
        parts.emplace_back(u - v, v);
        out.positive += u > v ? 1.0 / kSegments : 0;
    }
    std::ranges::sort(parts, std::greater<>());
    double gain = 0, square = 0;
    for (std::size_t k = kBestLeftOut; k < parts.size(); ++k) {
        gain += parts[k].first;
        square += parts[k].second;
    }
    out.gain = std::log(std::max(1 + (square > 0 ? gain / square : 0), 1e-9));
}

Comparison compared(const Regression& regression, const Matrix& output, const std::vector<Matrix>& valves) {
    Comparison out;
    const SeriesFit linear = regression.fit(output);
    out.linear = linear.least();
    SeriesFit best;
    for (std::size_t k = 0; k < valves.size(); ++k) {
        SeriesFit fit = regression.fit(valves[k]);
        out.squares.push_back(fit.least());
        if (best.squares.empty() || fit.least() < best.least()) {
            best = std::move(fit);
            out.valve = k;
        }
    }
    const auto& weights = best.weights[best.best()];
    out.direction = weights.sum() / (weights.cwiseAbs().sum() + 1e-300);
    compare_segments(regression.residual(output, linear, linear.best()),
                     regression.residual(valves[out.valve], best, best.best()), out);
    return out;
}

/// Regression A with the output's past, B without.
struct BothComparisons {
    Comparison a, b;
};

/// Everything over blocks.
struct Blocks {
    Vector y, u;
    std::vector<Vector> valves;
    int delays = 0;
    double cycles_per_block = 0;  ///< of the line

    Matrix harmonics() const {
        Matrix out(y.size(), 0);
        for (int k = 1; k <= kHarmonics && k * cycles_per_block < kHighest; ++k) {
            out.conservativeResize(Eigen::NoChange, out.cols() + 2);
            for (Eigen::Index i = 0; i < y.size(); ++i) {
                const double phase = 2 * std::numbers::pi * k * cycles_per_block * double(i);
                out(i, out.cols() - 2) = std::cos(phase);
                out(i, out.cols() - 1) = std::sin(phase);
            }
        }
        return out;
    }

    BothComparisons compare(const Matrix& further) const {
        const int skip = std::max({kOwnLags, kOutputLags, delays + kValveLags});
        const Eigen::Index n = y.size() - skip;
        Matrix b(n, kOwnLags + 1 + further.cols());
        b << lags(y, skip, 1, kOwnLags), Vector::Ones(n), further.bottomRows(n);
        Matrix a(n, b.cols() + kOutputLags);
        a << b, lags(u, skip, 1, kOutputLags);
        const int count = delays + kValveLags - 1;
        const Matrix output = lags(u, skip, 1, count);
        std::vector<Matrix> positions;
        for (const Vector& valve : valves) positions.push_back(lags(valve, skip, 1, count));
        const Vector left = y.tail(n);
        return {compared(Regression(a, left, delays), output, positions),
                compared(Regression(b, left, delays), output, positions)};
    }
};

/// The median number of rows from one upward crossing of zero to the next, in a band about the period, without the
/// first third of the record, in which a cycle may still build up.
double median_period(std::span<const double> y, double period) {
    const auto last = y.subspan(y.size() / 3);
    std::vector<double> x(last.begin(), last.end());
    const double centre = mean(x);
    for (double& value : x) value -= centre;
    auto X = half_spectrum(x);
    for (std::size_t k = 0; k < X.size(); ++k) {
        const double place = double(k) / double(x.size()) * period;
        if (!(place > kBelowPeriod && place < kAbovePeriod)) X[k] = 0;
    }
    const auto band = series_of(X, x.size());
    std::vector<double> cycles;
    double before = -1;
    for (std::size_t i = 1; i < band.size(); ++i) {
        if (!(band[i - 1] < 0 && band[i] >= 0)) continue;
        const double at = double(i) - band[i] / (band[i] - band[i - 1]);
        if (before >= 0) cycles.push_back(at - before);
        before = at;
    }
    return cycles.size() > 2 ? median(std::move(cycles)) : period;
}

/// The median over periods of the output's range within one.
double range_within(const std::vector<double>& output, double period) {
    const auto width = std::max<std::size_t>(4, static_cast<std::size_t>(std::lround(period)));
    std::vector<double> ranges;
    for (std::size_t from = 0; from + width <= output.size(); from += width) {
        const auto [low, high] = std::ranges::minmax(std::span(output).subspan(from, width));
        ranges.push_back(high - low);
    }
    if (ranges.size() > 1) return median(std::move(ranges));
    const auto [low, high] = std::ranges::minmax(output);
    return high - low;
}

/// The geometric mean of the bands, each weighted by its likelihood.
double weighted_band(const Comparison& comparison, const std::vector<double>& bands, double blocks) {
    const double least = std::ranges::min(comparison.squares);
    double sum = 0, weights = 0;
    for (std::size_t k = 0; k < bands.size(); ++k) {
        const double weight = std::exp(-0.5 * blocks * std::log(comparison.squares[k] / least));
        sum += weight * std::log(bands[k]);
        weights += weight;
    }
    return std::exp(sum / weights);
}

/// A and B both speak for the valve and drive the measurement the right way: fewer events suffice.
struct Agreement {
    double gain = 0.03, gain_b = 0.01, strength = 14, way = 0.12, least_ratio = 0.35, most_ratio = 0.98;
};
constexpr Agreement kAgreement;

/// Only A speaks for the valve, but clearly, nearly everywhere and the right way.
struct Strong {
    double gain = 0.06, gain_b = -0.2, strength = 14, way = 0.3, positive = 0.8, most_ratio = 0.98;
};
constexpr Strong kStrong;

struct Judged {
    const BothComparisons& plain;
    const std::optional<BothComparisons>& with_line;
    double blocks, regularity, sign, band_ratio;
};

/// Gains of A and B, the lesser of those with and without harmonics of a line.
struct Gains {
    double a = 0, b = 0;
    bool enough = false;  ///< for this kind of oscillation
};

Gains gains_of(const Judged& j) {
    Gains gains{j.plain.a.gain, j.plain.b.gain};
    if (j.with_line) {
        gains.a = std::min(gains.a, j.with_line->a.gain);
        gains.b = std::min(gains.b, j.with_line->b.gain);
        const double of_line = std::log(j.plain.a.linear / j.with_line->a.linear);
        gains.enough =
            ((gains.a >= kGainOfLine && gains.b >= kLeastBOfLine) || std::min(gains.a, gains.b) >= kBothOfLine) &&
            gains.a >= kShareOfLine * of_line;
    } else if (j.regularity >= kRegularHere) {
        gains.enough = gains.a >= kGainOfRegular && gains.b >= 0;
    } else {
        gains.enough = gains.a >= kGain && gains.b >= kLeastB;
    }
    return gains;
}

/// The gain if every condition holds, else empty.
std::optional<double> judged(const Judged& j) {
    const Gains gains = gains_of(j);
    const double strength = j.blocks * gains.a, positive = j.plain.a.positive;
    const double way = j.sign * j.plain.a.direction, way_b = j.sign * j.plain.b.direction, ratio = j.band_ratio;
    if (!j.with_line) {
        const bool irregular = j.regularity < kRegularHere && !gains.enough;
        if (irregular && gains.a >= kStrong.gain && strength >= kStrong.strength && gains.b >= kStrong.gain_b &&
            positive >= kStrong.positive && way >= kStrong.way && ratio <= kStrong.most_ratio)
            return gains.a;
        if (gains.a >= kAgreement.gain && gains.b >= kAgreement.gain_b && strength >= kAgreement.strength &&
            std::min(way, way_b) >= kAgreement.way && positive >= kPositive && ratio >= kAgreement.least_ratio &&
            ratio <= kAgreement.most_ratio)
            return gains.a;
    }
    const bool both = gains.a >= kBothGain && gains.b >= kBothGain;
    const bool everywhere =
        positive >= kPositive || (positive >= kPositiveOfStrong && std::min(gains.a, gains.b) >= kStrongGain);
    const bool events = strength >= kStrength || (both && strength >= kBothStrength);
    // The valve must drive the measurement the right way, and the output must travel further than the band to move it.
    const bool nearly = std::min(gains.a, gains.b) >= kNearlyBoth && std::max(gains.a, gains.b) >= kOneClear &&
                        way >= kNearlyWay && way_b >= kNearlyWayB;
    const bool drives = way > kWrongWay && (gains.a >= kClearGain || nearly || !(way < kBarely && way_b < kBarelyB));
    const bool reaches = ratio <= (j.regularity < kHardlyRegular ? kBandOfRange : kBandOfRangeRegular);
    return gains.enough && everywhere && events && drives && reaches ? std::optional(gains.a) : std::nullopt;
}

}  // namespace

ValveBank::ValveBank(std::span<const double> output, double period) {
    if (output.size() > kMostRows) {
        const double least = std::ceil(double(output.size()) / double(kMostRows));
        stride_ = static_cast<std::size_t>(std::max(1.0, std::min(period / kRowsPerPeriod, least)));
    }
    output_ = thinned(output);
    std::vector<double> sorted(output_);
    std::ranges::sort(sorted);
    const auto at = [&](double share) { return sorted[std::size_t(share * double(sorted.size() - 1))]; };
    if (!sorted.empty() && at(0.995) > at(0.005)) valves_ = valve_candidates(at(0.995) - at(0.005));
    positions_.resize(valves_.size());
}

std::vector<double> ValveBank::thinned(std::span<const double> values) const {
    std::vector<double> out;
    const std::size_t most = kMostRows * stride_;
    for (std::size_t i = values.size() > most ? values.size() - most : 0; i < values.size(); i += stride_)
        out.push_back(values[i]);
    return out;
}

const std::vector<double>& ValveBank::position(std::size_t k) const {
    if (positions_[k].empty()) positions_[k] = valve_position(output_, valves_[k]);
    return positions_[k];
}

std::optional<ValveFit> fit_valve(std::span<const double> measurement, const ValveBank& bank,
                                  const PeriodCandidate& candidate, double regularity, double sign) {
    const auto y = bank.thinned(measurement);
    const double stride = double(bank.stride()), period = candidate.period / stride;
    const double range = range_within(bank.output(), period);
    const auto block = static_cast<std::size_t>(
        std::max(1.0, std::min(period / kBlocksPerPeriod, std::floor(double(y.size()) / kFewestBlocks))));
    Blocks blocks;
    std::vector<double> bands, jumps;
    for (std::size_t k = 0; k < bank.valves().size(); ++k) {
        const ValveModel& valve = bank.valves()[k];
        if (valve.band < kLeastRatio * range || valve.band > kMostRatio * range) continue;
        blocks.valves.push_back(centred(block_means(bank.position(k), block)));
        bands.push_back(valve.band);
        jumps.push_back(valve.jump);
    }
    blocks.y = centred(block_means(y, block));
    blocks.u = centred(block_means(bank.output(), block));
    blocks.delays = std::clamp(int(std::ceil(kLongestDelay * period / double(block))), kFewestDelays, kMostDelays);
    if (bands.size() < 4 || blocks.y.size() < Eigen::Index(kFewestBlocks / 2)) return std::nullopt;
    const BothComparisons plain = blocks.compare(Matrix(blocks.y.size(), 0));
    std::optional<BothComparisons> with_line;
    if (candidate.line >= kLineLike) {
        blocks.cycles_per_block = double(block) * stride / candidate.line_period;
        if (const Matrix harmonics = blocks.harmonics(); harmonics.cols() > 0) with_line = blocks.compare(harmonics);
    }
    const int skip = std::max({kOwnLags, kOutputLags, blocks.delays + kValveLags});
    const double count = double(blocks.y.size() - skip);
    ValveFit fit;
    fit.band = weighted_band(plain.a, bands, count);
    fit.jump = jumps[plain.a.valve];
    const auto gain =
        judged({plain, with_line, count, regularity, sign, bands[plain.a.valve] / std::max(range, 1e-300)});
    fit.passes = gain.has_value();
    fit.gain = gain.value_or(plain.a.gain);
    fit.strength = count * fit.gain;
    fit.period = stride * median_period(y, period);
    return fit;
}

}  // namespace tunewright::check
