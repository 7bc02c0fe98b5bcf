#include "engine/identification/closed_loop/recognised_law.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/identification/closed_loop/set_point_part.h"
#include "engine/identification/controller_law/law_regression.h"
#include "engine/numerics/matrix/dense.h"

namespace tunewright {
namespace {

constexpr double kMaxUnexplainedOfLaw = 0.01;  ///< of u's variance

/// The rows with increasing times; u is at rest before it first moves.
LawSamples samples_of(const CleanRecord& record, const std::vector<double>& u, const std::vector<double>& r,
                      const std::vector<double>& automatic) {
    constexpr std::size_t kMinRestRows = 3;
    std::size_t rest = 0;
    while (rest + 1 < u.size() && u[rest + 1] == u.front()) ++rest;
    if (rest < kMinRestRows) rest = 0;
    LawRows rows;
    for (std::size_t i = 0; i < u.size(); ++i) {
        if (!rows.t.empty() && record.t[i] <= rows.t.back()) continue;
        rows.t.push_back(record.t[i]);
        rows.u.push_back(u[i]);
        rows.y.push_back(record.y[i]);
        if (!r.empty()) rows.r.push_back(r[i]);
        rows.manual.push_back(i < rest || (!automatic.empty() && automatic[i] == 0));
    }
    return each_row(std::move(rows));
}

/// The fits of one record's law: P, PI, PID.
class LawOfLevels {
public:
    LawOfLevels(const LawSamples& samples, const std::vector<char>& used) {
        LawColumns columns = law_columns(samples, {});
        if (samples.r.empty()) {
            columns[kLawLevel].assign(columns[kLawP].size(), 0.0);
            for (std::size_t j = 1; j < samples.t.size(); ++j) columns[kLawLevel][j] = samples.t[j] - samples.t[j - 1];
            set_point_ = {kLawLevel};
        } else if (set_point_moves(samples, used)) {
            set_point_ = {kLawSetPoint};
        }
        moments_ = law_moments(whitened(columns, used, 1, false));
    }

    LawFit with(std::vector<int> columns) const {
        columns.insert(columns.end(), set_point_.begin(), set_point_.end());
        return fit_law(moments_, columns);
    }

    /// Share of u's variance.
    double left(const LawFit& fit) const {
        const double total = moments_[kLawTarget][kLawTarget];
        return fit.solved && total > 0 ? fit.residual / total : 1;
    }

    /// PID only if the integral contributes, because a lag's output and its slope alone also explain its input.
    LawFit law() const {
        constexpr double kMinIntegralVarianceRatio = 4;  // times the variance that the law leaves without its integral
        const auto one_sign = [](const LawFit& fit) { return fit.value[kLawP] * fit.value[kLawI] >= 0; };
        const LawFit p = with({kLawP}), pi = with({kLawP, kLawI});
        if (left(p) < kMinIntegralVarianceRatio * left(pi) && left(p) < kMaxUnexplainedOfLaw) return p;
        if (left(pi) < kMaxUnexplainedOfLaw && one_sign(pi)) return pi;
        const LawFit pid = with({kLawP, kLawI, kLawD});
        return one_sign(pid) && kMinIntegralVarianceRatio * left(pid) < left(with({kLawP, kLawD})) ? pid : LawFit{};
    }

private:
    std::vector<int> set_point_;
    LawMoments moments_ = {};
};

/// Samples [from, to).
struct SampleRange {
    std::size_t from = 0, to = 0;
    std::size_t size() const { return to - from; }
};

SampleRange longest_stretch(const std::vector<char>& used) {
    SampleRange longest;
    for (std::size_t j = 1, from = 0; j < used.size(); ++j) {
        if (!used[j])
            from = j;
        else if (j + 1 - from > longest.size())
            longest = {from, j + 1};
    }
    return longest;
}

/// Explains u by itself: u about its mean as a straight line over time plus a multiple of its first or second integral.
struct OwnIntegral {
    double multiple = 0;
    double left = 1;  ///< share of u's variance
};

OwnIntegral by_integral_of_itself(const LawSamples& s, const SampleRange& rows, int order) {
    const auto n = static_cast<Eigen::Index>(rows.size());
    Eigen::MatrixXd X(n, 3);
    Eigen::VectorXd z(n);
    double middle = 0, once = 0, twice = 0;
    for (std::size_t j = rows.from; j < rows.to; ++j) middle += s.u[j] / static_cast<double>(rows.size());
    for (std::size_t j = rows.from; j < rows.to; ++j) {
        const double dt = j > rows.from ? s.t[j] - s.t[j - 1] : 0, before = once;
        once += j > rows.from ? (0.5 * (s.u[j] + s.u[j - 1]) - middle) * dt : 0;
        twice += 0.5 * (once + before) * dt;
        const auto row = static_cast<Eigen::Index>(j - rows.from);
        X.row(row) << 1, s.t[j], order == 1 ? once : twice;
        z[row] = s.u[j] - middle;
    }
    if (!(z.squaredNorm() > 0)) return {};
    const Eigen::VectorXd c = least_squares(X, z);
    return {c[2], (z - X * c).squaredNorm() / z.squaredNorm()};
}

/// True if u is two periods or more of a sine about a straight line: u'' = -w^2 u, integrated twice.
bool is_sine(const LawSamples& s, const SampleRange& rows) {
    constexpr double kMaxUnexplainedShare = 0.02, kTwoPeriods = 12.566370614359172;  // share of the variance; radians
    const OwnIntegral sine = by_integral_of_itself(s, rows, 2);
    const double length = s.t[rows.to - 1] - s.t[rows.from];
    return sine.left < kMaxUnexplainedShare && sine.multiple < 0 && std::sqrt(-sine.multiple) * length > kTwoPeriods;
}

/// Share of u's variance that remains if u is modelled as a lag after one step: u' = a + b u, integrated, plus a
/// straight line. A soft start has this form; a filter of y explains it too, with the noise of y.
double left_by_lagged_step(const LawSamples& s, const SampleRange& rows) {
    return by_integral_of_itself(s, rows, 1).left;
}

}  // namespace

std::optional<RecognisedLaw> recognised_law(const CleanRecord& record, const std::vector<double>& u,
                                            const std::vector<double>& r, const std::vector<double>& automatic) {
    constexpr int kMinIncrements = 39;
    const LawSamples samples = samples_of(record, u, r, automatic);
    const std::vector<char> used = law_increments(samples, true);
    if (std::ranges::count(used, 1) < kMinIncrements) return std::nullopt;
    const LawOfLevels levels(samples, used);
    const LawFit law = levels.law();
    const double left = levels.left(law);
    if (!(left < kMaxUnexplainedOfLaw)) return std::nullopt;
    const SampleRange longest = longest_stretch(used);
    if (is_sine(samples, longest) || left_by_lagged_step(samples, longest) <= left) return std::nullopt;
    // Kp of the backward rule.
    const double gain = law.value[kLawP] - 0.5 * samples.period * law.value[kLawI];
    return RecognisedLaw{-gain, law.value[kLawI], left};
}

double left_by_free_plant(const CleanRecord& record, const std::vector<double>& u) {
    std::vector<double> before(u);
    std::rotate(before.rbegin(), before.rbegin() + 1, before.rend());
    before.front() = u.front();
    const std::optional<SetPointPart> plant = set_point_part(record.y, before, u.front());
    return plant ? 1 - plant->share : 0;
}

}  // namespace tunewright
