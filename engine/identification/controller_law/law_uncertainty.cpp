#include "engine/identification/controller_law/law_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/identification/controller_law/law_rows.h"

namespace tunewright {
namespace {

std::size_t as_index(int column) { return static_cast<std::size_t>(column); }

/// d prediction/d ln Tf by a central difference, whitened.
std::vector<double> slope_over_filter(const LawSamples& s, const std::vector<char>& used, const FoundLaw& law) {
    constexpr double kStep = 0.02;
    LawShape up = law.shape, down = law.shape;
    up.ratio *= 1 + kStep;
    down.ratio /= 1 + kStep;
    const LawColumns a = whitened(law_columns(s, up), used, law.theta, s.r.empty()),
                     b = whitened(law_columns(s, down), used, law.theta, s.r.empty());
    std::vector<double> slope(a[kLawTarget].size(), 0.0);
    for (const int column : law.columns) {
        const std::size_t c = as_index(column);
        for (std::size_t k = 0; k < slope.size(); ++k) slope[k] += law.fit.value[c] * (a[c][k] - b[c][k]) / (2 * kStep);
    }
    return slope;
}

/// Sum over all pairs of rows up to n^(1/3) apart of their scores' products, Bartlett's weights.
LawCovariance long_run_moments(const LawResiduals& r, const std::vector<int>& columns) {
    const std::size_t n = r.e.size();
    const auto lags = static_cast<std::size_t>(std::cbrt(static_cast<double>(n)));
    LawCovariance sum = {};
    for (const int a : columns)
        for (const int b : columns)
            for (std::size_t lag = 0; lag <= lags; ++lag) {
                const std::vector<double>&x = r.white[as_index(a)], &y = r.white[as_index(b)];
                double products = 0;
                for (std::size_t k = lag; k < n; ++k) {
                    const double ee = r.e[k] * r.e[k - lag];
                    products += ee * (lag > 0 ? x[k] * y[k - lag] + x[k - lag] * y[k] : x[k] * y[k]);
                }
                sum[as_index(a)][as_index(b)] +=
                    products * (1 - static_cast<double>(lag) / static_cast<double>(lags + 1));
            }
    return sum;
}

}  // namespace

LawCovariance law_covariance(const LawSamples& s, const std::vector<char>& used, const FoundLaw& law) {
    LawResiduals r = law_residuals(s, used, law);
    std::vector<int> columns = law.columns;
    if (law.shape.filter != LawFilter::none) {
        r.white[kLawFilter] = slope_over_filter(s, used, law);
        columns.push_back(kLawFilter);
    }
    LawCovariance out = {};
    const LawFit f = fit_law(law_moments(r.white), columns);
    if (!f.solved) {
        for (const int c : columns) out[as_index(c)][as_index(c)] = std::numeric_limits<double>::infinity();
        return out;
    }
    const LawCovariance meat = long_run_moments(r, columns);
    LawCovariance half = {};
    for (std::size_t i = 0; i < kLawColumns; ++i)
        for (std::size_t k = 0; k < kLawColumns; ++k)
            for (std::size_t a = 0; a < kLawColumns; ++a) half[i][k] += f.inverse[i][a] * meat[a][k];
    for (std::size_t i = 0; i < kLawColumns; ++i)
        for (std::size_t k = 0; k < kLawColumns; ++k)
            for (std::size_t a = 0; a < kLawColumns; ++a) out[i][k] += half[i][a] * f.inverse[a][k];
    double square = 0;
    for (const double e : r.e) square += e * e;
    square /= std::max(1.0, static_cast<double>(r.e.size()) - static_cast<double>(columns.size()));
    for (const int column : columns) {
        const std::size_t c = as_index(column);
        const double plain = square * f.inverse[c][c];
        if (!(out[c][c] < plain)) continue;
        if (!(out[c][c] > 0)) {  // by rounding
            out[c][c] = plain;
            continue;
        }
        const double factor = std::sqrt(plain / out[c][c]);
        for (std::size_t k = 0; k < kLawColumns; ++k) {
            out[c][k] *= factor;
            out[k][c] *= factor;
        }
    }
    return out;
}

double white_noise(const std::vector<double>& y) {
    if (y.size() < 5) return 0;
    double sum = 0;
    for (std::size_t j = 3; j < y.size(); ++j) {
        const double third = y[j] - 3 * y[j - 1] + 3 * y[j - 2] - y[j - 3];
        sum += third * third;
    }
    return std::sqrt(sum / (20 * static_cast<double>(y.size() - 3)));  // 1 + 9 + 9 + 1
}

LawFit without_errors_of_y(const LawSamples& s, const LawMoments& m, const FoundLaw& law, double variance) {
    constexpr std::size_t kLength =
        400;  // samples after an error of y: those of theta < 1 and of usual filters die out
    LawSamples impulse;
    impulse.period = s.period;
    for (std::size_t j = 0; j < kLength; ++j) {
        impulse.t.push_back(s.period * static_cast<double>(j));
        impulse.row.push_back(static_cast<int>(j));
    }
    impulse.u.assign(kLength, 0.0);
    impulse.rows_y.assign(kLength, 0.0);
    impulse.rows_y[5] = 1;
    LawShape shape = law.shape;
    shape.delay_rows = 0;
    shape.delay_sample = false;
    const LawColumns columns = law_columns(impulse, shape);
    const auto response = [&](std::size_t column) {
        std::vector<double> out = columns[column];
        for (std::size_t j = 1; j < kLength; ++j) out[j] += law.theta * out[j - 1];
        return out;
    };
    const std::array<std::vector<double>, 2> h = {response(kLawP), response(kLawD)};
    const std::array<std::size_t, 2> at = {kLawP, kLawD};
    LawMoments less = m;
    for (std::size_t a = 0; a < 2; ++a)
        for (std::size_t b = 0; b < 2; ++b) {
            double sum = 0;
            for (std::size_t j = 0; j < kLength; ++j) sum += h[a][j] * h[b][j];
            less[at[a]][at[b]] -= sum * variance * law.samples;
        }
    return fit_law(less, law.columns);
}

}  // namespace tunewright
