#include "engine/identification/search/diagnosis.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "engine/identification/record/series.h"
#include "engine/identification/record/settled_levels.h"
#include "engine/number_text.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

double root_mean_square(const std::vector<double>& x) {
    return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())).norm() /
           std::sqrt(static_cast<double>(x.size()));
}

constexpr double kMinDivisor = 1e-300;   ///< keeps a division by a value near 0 finite
constexpr double kSettledWithin = 0.05;  ///< of the largest distance from rest, as for the 5 % settling time

bool self_regulating(const Fit& fit) {
    return !is_integrating(fit.form.structure) && fit.form.structure != Structure::unstable;
}

/// The movement after the last sample, relative to the largest distance from rest so far. 1 for structures that do not
/// settle.
double remaining_movement(const CleanRecord& r, const Fit& fit) {
    if (!self_regulating(fit)) return 1;
    double offset = fit.linear[fit.form.offset_index()];
    if (fit.form.other_level) offset += fit.linear[fit.form.level_index()];
    if (fit.form.load) offset += fit.linear[fit.form.load_index()];
    if (fit.form.slope) offset += fit.linear[fit.form.slope_index()] * r.t.back();
    double moved = 0;
    for (double y : fit.model) moved = std::max(moved, std::abs(y - offset));
    double final_value = fit.linear[0] * r.v_level.back() + offset;
    for (int k = 0; k < fit.form.further; ++k)
        final_value += fit.linear[fit.form.further_index() + k] * r.d[static_cast<std::size_t>(k)].level.back();
    return std::abs(final_value - fit.model.back()) / std::max(moved, kMinDivisor);
}

void warn_unsettled(const CleanRecord& r, const Fit& fit, double remaining, std::vector<Warning>& warnings) {
    if (!self_regulating(fit) || remaining <= kSettledWithin || r.changes() > 2) return;
    warnings.push_back(
        {"unsettled-record",
         "The record ends while y is still moving: according to the model " +
             text(100 * remaining / (1 + remaining), 3) +
             " % of the response is missing, so gain and time constant are extrapolated. Record until y settles."});
}

/// Adds the warnings on residuals; true if the model leaves a pattern in them.
bool warn_residuals(const CleanRecord& r, const Fit& fit, const DataQuality& quality, std::vector<Warning>& warnings) {
    const double rms = root_mean_square(fit.residual), unit = r.scale.y_scale;
    const double noise = std::max(quality.noise_std, quality.quantisation / std::sqrt(12.0)) / unit;
    constexpr double kMinVisibleRms = 0.007;                         // of y's range: visible in the plot
    constexpr double kMinNoiseRatio = 1.5, kMinCorrelationTime = 3;  // multiple of the noise; samples of correlation
                                                                     // time
    constexpr double kMaxResidualInRms = 8;                          // multiple of the root mean square
    const bool pattern =
        rms > kMinVisibleRms && rms > kMinNoiseRatio * noise && correlation_time(fit.residual) > kMinCorrelationTime;
    if (pattern) {
        warnings.push_back(
            {"structured-residuals", "The model differs from y by " + text(rms * unit, 3) +
                                         " (r.m.s.), more than noise or rounding (" + text(noise * unit, 3) +
                                         ") explain, and the differences are not random. The record contains a "
                                         "disturbance, a drift, a nonlinearity or a more complex response: compare y "
                                         "and model in the plot, try another model or repeat the test."});
    }
    double worst = 0;
    for (double e : fit.residual) worst = std::max(worst, std::abs(e));
    if (worst > kMaxResidualInRms * rms) {
        warnings.push_back({"outliers", "At least one sample lies " + text(worst * unit, 3) +
                                            " from the model, "
                                            "while " +
                                            text(rms * unit, 3) +
                                            " is typical; remove false readings from the record."});
    }
    return pattern;
}

void warn_uncertain(const std::map<std::string, double>& values, const std::map<std::string, double>& errors,
                    std::vector<Warning>& warnings) {
    constexpr double kMaxCertainError = 0.2,
                     kMinUnknownError = 0.5;  // standard error over the parameter, or over half of all lags
    double lag_sum = values.at("L");
    for (const char* lag : {"T", "T1", "T2", "a1"}) lag_sum += values.contains(lag) ? std::abs(values.at(lag)) : 0;
    for (const auto& [name, error] : errors) {
        const bool is_time = name == "L" || name == "T2" || name == "b" || name == "T";
        const double yardstick =
            is_time ? std::max(std::abs(values.at(name)), 0.5 * lag_sum) : std::abs(values.at(name));
        if (error <= kMaxCertainError * yardstick) continue;
        const bool unknown_gain = name == "K" && error > kMinUnknownError * yardstick;
        warnings.push_back({"uncertain-parameters",
                            name + " = " + text(values.at(name)) + " has a standard error of " + text(error, 2) +
                                ": the record hardly determines it. Use a larger or longer test, or a simpler model.",
                            unknown_gain ? WarningLevel::bad : WarningLevel::warning});
    }
}

/// A straight line through the samples before the first change of u.
void warn_not_at_rest(const CleanRecord& r, std::vector<Warning>& warnings) {
    constexpr int kMinSamples = 5;                                // samples that distinguish a slope from its error
    constexpr double kMinDrift = 0.03, kSlopeStandardErrors = 5;  // of y's range; standard errors of the slope
    const int n = static_cast<int>(std::lower_bound(r.t.begin(), r.t.end(), r.v_time.front()) - r.t.begin());
    if (n < kMinSamples || r.t[n - 1] <= r.t[0]) return;
    const auto rest = static_cast<std::size_t>(n);
    const Line line = straight_line(std::span(r.t).first(rest), std::span(r.y).first(rest));
    const double slope = line.slope, moved = std::abs(slope) * (r.t[n - 1] - r.t[0]);
    if (moved < kMinDrift || std::abs(slope) < kSlopeStandardErrors * line.slope_std) return;
    warnings.push_back(
        {"not-at-rest",
         "Before u moves, y already changes by " + text(moved * r.scale.y_scale, 3) + " before u changes, " +
             text(100 * moved, 2) +
             " % of its range: the test did not start at rest, or y drifts. Start the test from a steady state."});
}

void warn_sampling(const CleanRecord& r, const Fit& fit, const DataQuality& quality, std::vector<Warning>& warnings) {
    constexpr double kManyDropped = 0.05;  // of the rows
    constexpr double kFewSteps = 10;       // steps of y's grid in its range
    constexpr double kLongLag = 50;        // record lengths: half of the longest lag that is searched
    const int rows = quality.samples + quality.samples_dropped;
    if (quality.samples_dropped > kManyDropped * rows) {
        warnings.push_back({"rows-dropped", std::to_string(quality.samples_dropped) + " of " + std::to_string(rows) +
                                                " rows could not be used."});
    }
    if (quality.quantisation * kFewSteps > r.scale.y_scale) {
        warnings.push_back(
            {"coarse-quantisation", "y covers only " + text(r.scale.y_scale / quality.quantisation, 3) +
                                        " steps of its grid (" + text(quality.quantisation, 3) +
                                        "). A larger step of u or a finer sensor range gives a better model."});
    }
    if (fit.form.structure == Structure::fopdt && fit.shape.T() >= kLongLag) {
        warnings.push_back({"looks-integrating",
                            "The time constant is at least 50 times the record's length: the record looks like that of "
                            "an integrating process. Use model ipdt."});
    }
    if (fit.form.structure == Structure::ipdt) return;
    const double slowest = (is_integrating(fit.form.structure) ? fit.shape.T() : fit.shape.a1()) * r.scale.t_scale;
    if (!is_integrating(fit.form.structure) && slowest < quality.sample_time) {
        warnings.push_back({"undersampled-response", "The time constant (" + text(slowest, 3) +
                                                         ") is shorter than the spacing of the samples "
                                                         "(" +
                                                         text(quality.sample_time, 3) +
                                                         "), so the samples cannot show it. Record faster."});
    }
}

}  // namespace

bool responds(const CleanRecord& r, const Fit& fit) {
    const double floor = kVarianceFloor * r.samples();
    const double ratio = (squares_about_mean(r.y) + floor) / (fit.sse + floor);
    constexpr double kMinVarianceRatio = 10,
                     kMinEvidence = 30;  // of the variance; of the criterion beyond the cost of the parameters
    const double n = effective_samples(fit.residual);
    return ratio > kMinVarianceRatio || n * std::log(ratio) > (fit.form.parameters() - 1) * std::log(n) + kMinEvidence;
}

Diagnosis diagnose(const CleanRecord& record, const Fit& fit, const std::map<std::string, double>& values,
                   const std::map<std::string, double>& standard_errors, const DataQuality& quality) {
    Diagnosis diagnosis;
    const double remaining = remaining_movement(record, fit);
    diagnosis.settled = remaining < kSettledWithin;
    warn_unsettled(record, fit, remaining, diagnosis.warnings);
    if (!fit.form.other_level && !fit.form.slope) warn_not_at_rest(record, diagnosis.warnings);
    if (warn_residuals(record, fit, quality, diagnosis.warnings) && self_regulating(fit)) {
        if (auto warning = level_warning(record)) diagnosis.warnings.push_back(std::move(*warning));
    }
    warn_uncertain(values, standard_errors, diagnosis.warnings);
    warn_sampling(record, fit, quality, diagnosis.warnings);
    return diagnosis;
}

}  // namespace tunewright
