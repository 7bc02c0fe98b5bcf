#include "engine/identification/controller_law/identify_controller.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/identification/controller_law/law_rows.h"
#include "engine/identification/controller_law/law_search.h"
#include "engine/identification/controller_law/law_terms.h"
#include "engine/identification/controller_law/law_uncertainty.h"
#include "engine/number_text.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

/// Found on the loops 0 to 399 of tests/engine/identification/simulated_controller.h, checked on others.
struct LawLimits {
    int min_increments = 80;           ///< fewer give errors of Kp and Ti that are too small
    double min_explained = 0.5;        ///< loops whose u has other inputs too explain less, those that sample y do not
    double min_b = -0.2, max_b = 1.3;  ///< beyond 0 to 1 by more than the errors of what is answered
    /// Relative; of those above, errors are honest but too large for a figure to be of use.
    double max_Kp_error = 0.5;
    /// Relative, of Kp and Ti, and rows used: of simulated loops within both, 98 % are within 5 % and three standard
    /// errors and none of 455 was off by 20 %; with fewer rows or larger errors one in ten is off by more than 5 %.
    double max_certain_error = 0.03;
    int min_certain_rows = 150;
    /// Relative to u's moves: smaller residuals are rounding of the record's last digits.
    double min_residual = 1e-4;
    /// Noise of u over that of Kp y, and share of u's moves that the law leaves: less noise says that the controller
    /// reads y without the record's noise, if it is no filter that explains nearly all moves.
    double max_noise_in_u = 0.4, min_left_without_noise = 0.1;
    /// Relative: programs differ in the order of their sums, in what a limit does to the integral and in rounding.
    double min_error = 0.007;
};
constexpr LawLimits kLimits;

std::string percent(double share) { return text(std::ceil(100 * share)) + " %"; }

Error refused(const std::string& why) { return {ErrorKind::not_identifiable, "record", why, {}}; }

std::optional<Error> fault_of(const Record& record, const ControllerRecordOptions& options) {
    const std::size_t n = record.t.size();
    if (record.u.size() != n || record.y.size() != n || (!record.r.empty() && record.r.size() != n))
        return Error{ErrorKind::invalid_argument, "record", "t, u, y and r must have equal lengths.", {}};
    if (!record.automatic.empty() && record.automatic.size() != n)
        return Error{ErrorKind::invalid_argument, "record/mode", "mode must be as long as t.", {}};
    if (options.sample_time && !(*options.sample_time > 0))
        return Error{ErrorKind::invalid_argument,
                     "sample_time",
                     "sample_time is " + text(*options.sample_time) + "; it must be above 0.",
                     {}};
    return std::nullopt;
}

LawFilter filter_of(FilterType type) {
    switch (type) {
        case FilterType::none: return LawFilter::none;
        case FilterType::derivative: return LawFilter::derivative;
        default: return LawFilter::measurement;
    }
}

int count(const std::vector<char>& used) { return static_cast<int>(std::ranges::count(used, 1)); }

/// u in the rows that are used, one after the other.
std::vector<double> moving(const LawSamples& s, const std::vector<char>& used) {
    std::vector<double> u;
    for (std::size_t j = 0; j < used.size(); ++j)
        if (used[j]) u.push_back(s.u[j]);
    return u;
}

double deviation_of_moves(const LawSamples& s, const std::vector<char>& used) {
    std::vector<double> moves;
    for (std::size_t j = 1; j < used.size(); ++j)
        if (used[j]) moves.push_back(s.u[j] - s.u[j - 1]);
    return deviation(moves);
}

/// What steps 1 to 3 find.
struct LawOfRecord {
    LawSamples samples;
    std::vector<char> used;
    FoundLaws laws;  ///< the best first
    bool other_reading = false;
    int odd = 0;
};

Expected<LawOfRecord> law_of_record(const Record& record, const ControllerRecordOptions& options) {
    LawOfRecord out;
    LawSamples& s = out.samples = law_samples(record);
    const auto too_few = [&](int rows) {
        return refused("The record has " + std::to_string(rows) +
                       " rows in which the controller moves u in automatic; " + std::to_string(kLimits.min_increments) +
                       " are needed. Record a longer time in automatic.");
    };
    if (s.size() < kLimits.min_increments) return too_few(s.size());
    const double u_deviation = deviation(s.u);
    if (!(u_deviation > 0.9 * s.u_step)) return refused("u does not move. Record a move of the set point or a load.");
    if (!(deviation(s.y) > 0)) return refused("y does not move. Record a move of the set point or a load.");
    out.used = law_increments(s, false);
    if (count(out.used) < kLimits.min_increments) out.used = law_increments(s, true);
    if (count(out.used) < kLimits.min_increments) return too_few(count(out.used));
    const double least = std::max(s.u_step / std::sqrt(24.0), kLimits.min_residual * deviation_of_moves(s, out.used));
    for (int pass = 0; pass < 3; ++pass) {
        out.laws = search_law(s, out.used, least, out.other_reading, out.laws);
        if (out.laws.empty())
            return refused(
                "u does not follow y as a PID controller's output does. Check that u is this loop's own output.");
        const FoundLaw law = out.laws.front();
        if (pass == 0) {
            const double noise = std::abs(law.fit.value[kLawP]) * white_noise(s.y);
            const double left =
                law.fit.residual / law_moments(law_residuals(s, out.used, law).white)[kLawTarget][kLawTarget];
            out.other_reading = left > kLimits.min_left_without_noise &&
                                white_noise(moving(s, out.used)) < kLimits.max_noise_in_u * noise;
            take_still_in(s, law, out.other_reading ? 6 * noise : 3 * std::sqrt(law.fit.residual / law.samples));
            out.used = law_increments(s, false);
            if (count(out.used) < kLimits.min_increments) return too_few(count(out.used));
            // The law is another one: its first moves of the set point would be odd.
            const bool first_moves = set_point_moves(s, out.used) && !law.has(kLawSetPoint);
            if (out.other_reading || first_moves) out.laws.clear();
        }
        if (pass < 2 && !out.laws.empty()) out.odd += leave_odd_out(s, out.used, law, least);
    }
    leave_zero_terms_out(s, out.used, out.laws);
    if (options.filter) prefer_filter(filter_of(*options.filter), out.laws);
    return out;
}

/// Kp of the backward rule is Kp' - Ki h (centre +- width), h the sample spacing; that of the forward rule lies as far
/// on the other side of Kp'.
struct RowTiming {
    bool own = false;  ///< the rows are the controller's samples
    double centre = 0.5, width = 0;
};

double side_of(IntegralRule rule) {
    return rule == IntegralRule::backward ? 1 : rule == IntegralRule::trapezoidal ? 0 : -1;
}

/// Noise of y between the rows, which a controller that is quicker than they are integrates too, leaves a residual of
/// u; where there is noise and no such residual, the rows are the controller's own.
RowTiming row_timing(const LawSamples& s, const ControllerRecordOptions& options, double Ki, double error_square,
                     double rounding_square) {
    constexpr double kUnseenShare = 0.7;  // of Ki h times the noise: between 2 and infinitely many samples in a row
    if (s.rows_per_sample > 1) return {.own = true};
    if (options.sample_time) {
        const double share = *options.sample_time / s.period;
        return share > 0.9 ? RowTiming{.own = true} : RowTiming{.centre = 0.5 * share};
    }
    const double between = kUnseenShare * std::abs(Ki) * s.period * white_noise(s.y);
    const double unexplained = std::sqrt(std::max(0.0, error_square - rounding_square));
    if (unexplained < 0.25 * between) return {.own = true};
    if (between > 1.5 * std::sqrt(error_square) && unexplained < 0.6 * between) return {.centre = 0.5};
    if (between > std::sqrt(rounding_square) && unexplained > 0.6 * between) return {.centre = 0.125, .width = 0.125};
    return {.centre = 0.25, .width = 0.25};
}

/// Kp and Ti of one fit.
struct GainAndTime {
    double Kp = 0, Ki = 0;
    double Ti() const { return Kp / Ki; }
};

GainAndTime settings_of(const LawFit& fit, double rule_time) {
    return {fit.value[kLawP] - rule_time * fit.value[kLawI], fit.value[kLawI]};
}

/// The largest squared relative difference from `now` that other fits make.
struct Shift {
    GainAndTime now;
    double rule_time = 0;
    double Kp = 0, Ti = 0;

    void count_in(const LawFit& other, double weight) {
        if (!other.solved) return;
        const GainAndTime then = settings_of(other, rule_time);
        Kp = std::max(Kp, weight * std::pow(then.Kp / now.Kp - 1, 2));
        if (now.Ki != 0 && then.Ki != 0) Ti = std::max(Ti, weight * std::pow(then.Ti() / now.Ti() - 1, 2));
    }
};

class ControllerEstimate {
public:
    ControllerEstimate(const LawOfRecord& found, const ControllerRecordOptions& options)
        : found_(found), s_(found.samples), law_(found.laws.front()), side_(side_of(options.integral)) {
        const LawResiduals r = law_residuals(s_, found.used, law_);
        moments_ = law_moments(r.white);
        const double whitening = 2 / (1 + law_.theta);  // of the variance of what is white in u itself
        const double error = law_.fit.residual / law_.samples, rounding = s_.u_step * s_.u_step / 12 * whitening;
        explained_ = 1 - law_.fit.residual / moments_[kLawTarget][kLawTarget];
        timing_ = row_timing(s_, options, law_.fit.value[kLawI], error, rounding);
        y_variance_ = std::max(0.0, error - rounding) / whitening / (law_.fit.value[kLawP] * law_.fit.value[kLawP]);
        const double y_rounding = s_.y_step * s_.y_step / 12;
        // A residual below that of rounded y says that the controller read y as rounded as the record has it.
        constexpr double kMinShareOfRounding = 0.3, kShareAfterFilter = 0.01;
        const LawFit corrected = without_errors_of_y(
            s_, moments_, law_, found.other_reading ? y_variance_ : std::min(y_variance_, y_rounding));
        // Noise of several steps makes the errors of rounding white, and small beside y's moves.
        constexpr double kCoarseSteps = 3;
        y_may_be_rounded_ =
            white_noise(s_.y) < kCoarseSteps * s_.y_step && y_variance_ > kShareAfterFilter * y_rounding;
        const bool correct = corrected.solved && (found.other_reading || s_.y_step > 0) &&
                             y_variance_ > kMinShareOfRounding * y_rounding;
        fit_ = correct ? corrected : law_.fit;
        other_fit_ = correct ? law_.fit : corrected;
        covariance_ = law_covariance(s_, found.used, law_);
        find_errors();
    }

    double Kp_error() const { return Kp_error_; }
    double Ti_error() const { return Ti_error_; }
    double explained() const { return explained_; }
    bool has_integral() const { return law_.has(kLawI); }

    IdentifiedController answer(const ControllerRecordOptions& options) const {
        IdentifiedController out;
        out.pid.Kp = now_.Kp;
        out.standard_errors["Kp"] = Kp_error_ * std::abs(now_.Kp);
        if (law_.has(kLawI)) {
            out.pid.Ti = now_.Ti();
            out.standard_errors["Ti"] = Ti_error_ * out.pid.Ti;
        }
        if (law_.has(kLawD)) {
            out.pid.Td = fit_.value[kLawD] / now_.Kp;
            out.standard_errors["Td"] = std::sqrt(covariance_[kLawD][kLawD]) / std::abs(now_.Kp);
        }
        out.b_known = set_point_moves(s_, found_.used);
        if (out.b_known) {
            // The set point of the same row is integrated: of the sample before by the other rules.
            const double later = (1 - side_) * timing_.centre * s_.period;
            const double b = (fit_.value[kLawSetPoint] + later * now_.Ki) / now_.Kp;
            const double error = ratio_error(kLawSetPoint, kLawP, b);
            out.b_known = distinguishes_weights(error);
            if (out.b_known) {
                out.standard_errors["b"] = error;
                out.pid.b = usual_weight(b, error);
            }
        }
        if (law_.has(kLawSetPointD)) {
            const double c = fit_.value[kLawSetPointD] / fit_.value[kLawD];
            out.pid.c = usual_weight(c, ratio_error(kLawSetPointD, kLawD, c));
        }
        if (law_.shape.filter != LawFilter::none) {
            const FilterType type = law_.shape.filter == LawFilter::derivative ? FilterType::derivative
                                                                               : FilterType::measurement_first_order;
            out.pid.filter = {type, law_.shape.ratio * s_.period};
            out.standard_errors["Tf"] = out.pid.filter.Tf * std::sqrt(covariance_[kLawFilter][kLawFilter]);
        }
        if (options.sample_time)
            out.sample_time = options.sample_time;
        else if (timing_.own)
            out.sample_time = s_.period;
        out.delay = law_.shape.delay_sample ? s_.period : law_.shape.delay_rows * s_.period / s_.rows_per_sample;
        out.explained = explained_;
        out.rows = count(found_.used);
        out.manual_rows = s_.manual_rows;
        for (std::size_t j = 0; j < s_.still.size(); ++j)
            out.manual_rows += s_.still[j] && !s_.limited[j] && !s_.excluded[j];
        out.limited_rows = count(s_.limited);
        out.odd_rows = found_.odd;
        return out;
    }

private:
    /// Standard deviation of a weight, the quotient of two coefficients.
    double ratio_error(LawColumn weighted, LawColumn gain, double weight) const {
        const auto& c = covariance_;
        const double square = c[weighted][weighted] - 2 * weight * c[weighted][gain] + weight * weight * c[gain][gain];
        return std::sqrt(std::max(0.0, square) / std::pow(fit_.value[gain], 2) + kLimits.min_error * kLimits.min_error);
    }

    /// False: 0 and 1 may both be meant.
    static bool distinguishes_weights(double error) { return kZeroDeviations * error < 0.5; }

    /// The nearer of 0 and 1, the usual weights, if the record does not show another.
    static double usual_weight(double weight, double error) {
        const double usual = weight < 0.5 ? 0 : 1;
        return std::abs(weight - usual) <= kZeroDeviations * error ? usual : weight;
    }

    void find_errors() {
        const double rule_time = side_ * timing_.centre * s_.period;
        now_ = settings_of(fit_, rule_time);
        const double P = covariance_[kLawP][kLawP], I = covariance_[kLawI][kLawI], PI = covariance_[kLawP][kLawI];
        const double rule = side_ * timing_.width * std::abs(now_.Ki) * s_.period;
        const double Kp_square = P + rule_time * rule_time * I - 2 * rule_time * PI + rule * rule;
        Shift shift{.now = now_, .rule_time = rule_time};
        count_alternatives(shift);
        Kp_error_ = std::sqrt(std::max(0.0, Kp_square) / (now_.Kp * now_.Kp) + shift.Kp +
                              kLimits.min_error * kLimits.min_error);
        if (!has_integral()) return;
        const double relative =
            Kp_square / (now_.Kp * now_.Kp) + I / (now_.Ki * now_.Ki) - 2 * (PI - rule_time * I) / (now_.Kp * now_.Ki);
        Ti_error_ = std::sqrt(std::max(0.0, relative) + shift.Ti + kLimits.min_error * kLimits.min_error);
    }

    /// Other laws nearly as good, errors of y, other error models. Weights are shares of the squared difference: 1 for
    /// a law that is as good, 1/4 for half the difference, less where the alternative is an extreme.
    void count_alternatives(Shift& shift) const {
        constexpr double kRounding = 0.25, kReverse = 0.1, kTheta = 0.3, kSameOnY = 0.3, kRoundedY = 0.3;
        constexpr double kSameOnYRange = 0.3;  // of the criterion, a row
        for (const FoundLaw& other : found_.laws) {
            if (other.has(kLawI) != has_integral()) continue;
            // A filter of the measurement and a derivative that cancel: the same law with one more free constant.
            if (other.shape.filter == LawFilter::measurement && other.has(kLawD) && !law_.has(kLawD)) continue;
            const double worse = std::abs(other.criterion - law_.criterion);
            // A filter of the derivative is one of the measurement with other gains; only the set point tells them.
            const bool same_on_y = law_.has(kLawD) && other.has(kLawD) && worse < kSameOnYRange * law_.samples;
            // Errors of rounded y are not white where y moves slowly; a filter or a derivative then explains them.
            const double least = y_may_be_rounded_ ? kRoundedY : same_on_y ? kSameOnY : 0;
            shift.count_in(other.fit, std::max(least, std::exp(-worse / as_good(law_))));
        }
        shift.count_in(other_fit_, y_may_be_rounded_ ? 1 : kRounding);
        shift.count_in(without_errors_of_y(s_, moments_, law_, y_variance_), kReverse * law_.theta);
        const LawColumns columns = law_columns(s_, law_.shape);
        for (const double theta : {found_.other_reading ? law_.theta : 0.5 * law_.theta, 1 - 0.3 * (1 - law_.theta)}) {
            if (theta == law_.theta) continue;
            const LawColumns white = whitened(columns, found_.used, theta, s_.r.empty());
            shift.count_in(fit_law(law_moments(white), law_.columns), kTheta);
        }
    }

    const LawOfRecord& found_;
    const LawSamples& s_;
    const FoundLaw& law_;
    double side_;
    LawMoments moments_ = {};
    RowTiming timing_;
    LawFit fit_, other_fit_;
    LawCovariance covariance_ = {};
    GainAndTime now_;
    bool y_may_be_rounded_ = false;  ///< in the record, not where the controller reads it
    double explained_ = 0, y_variance_ = 0, Kp_error_ = 0, Ti_error_ = 0;
};

}  // namespace

Expected<IdentifiedController> identify_controller(const Record& record, const ControllerRecordOptions& options) {
    if (auto fault = fault_of(record, options)) return *std::move(fault);
    const Expected<LawOfRecord> found = law_of_record(record, options);
    if (!found) return found.error();
    const ControllerEstimate estimate(*found, options);
    if (!(estimate.explained() > kLimits.min_explained))
        return refused(
            "A PID law explains " + text(std::round(100 * std::max(0.0, estimate.explained()))) +
            " % of the moves of u; " + text(100 * kLimits.min_explained) +
            " % are needed. Check that u is this loop's own output and that no other signal is added to it.");
    const double b = estimate.answer(options).pid.b;
    if (!(b > kLimits.min_b && b < kLimits.max_b))
        return refused("u moves with the set point " + text(b) +
                       " times as far as with y; a PID law has a set-point weight from 0 to 1. Check that the set "
                       "point is this loop's own.");
    if (!(estimate.Kp_error() < kLimits.max_Kp_error))
        return refused("The record leaves the settings open: Kp is known to " + percent(estimate.Kp_error()) +
                       ". Record moves of the set point in automatic, with the controller's own sample time.");
    IdentifiedController out = estimate.answer(options);
    out.certain = estimate.Kp_error() <= kLimits.max_certain_error &&
                  estimate.Ti_error() <= kLimits.max_certain_error && out.rows >= kLimits.min_certain_rows;
    if (!out.certain)
        out.warnings.push_back({"controller-uncertain",
                                std::to_string(out.rows) + " rows of the record give Kp to " +
                                    percent(estimate.Kp_error()) +
                                    (estimate.has_integral() ? " and Ti to " + percent(estimate.Ti_error()) : "") +
                                    ", one standard deviation. Compare with the settings in the controller.",
                                WarningLevel::warning});
    return out;
}

}  // namespace tunewright
