#include "engine/identification/controller_law/law_regression.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tunewright {
namespace {

/// The signal that the controller reads at each sample.
std::vector<double> read_at_samples(const LawSamples& s, const std::vector<double>& rows, const LawShape& shape) {
    std::vector<double> out(s.t.size());
    for (std::size_t j = 0; j < out.size(); ++j) {
        const std::size_t at = shape.delay_sample && j > 0 ? j - 1 : j;
        const double place = std::max(0.0, s.row[at] - shape.delay_rows);
        const auto before = static_cast<std::size_t>(place);
        const double share = place - static_cast<double>(before);
        out[j] = share > 0 ? rows[before] + share * (rows[before + 1] - rows[before]) : rows[before];
    }
    return out;
}

/// y_f = y/(1 + s Tf): backward Euler at the samples, or exact on straight lines between them.
std::vector<double> lagged(const std::vector<double>& x, double ratio, bool between) {
    std::vector<double> out(x);
    const double a = between ? std::exp(-1 / ratio) : ratio / (1 + ratio);
    const double latest = between ? 1 - (1 - a) * ratio : 1 - a;
    for (std::size_t j = 1; j < x.size(); ++j) out[j] = a * out[j - 1] + (1 - a - latest) * x[j - 1] + latest * x[j];
    return out;
}

/// Increments of the derivative of x through its filter.
std::vector<double> slope_moves(const std::vector<double>& x, const std::vector<double>& t, double ratio,
                                bool between) {
    std::vector<double> out(x.size(), 0.0);
    const double a = !(ratio > 0) ? 0 : between ? std::exp(-1 / ratio) : ratio / (1 + ratio);
    double slope = 0;
    for (std::size_t j = 1; j < x.size(); ++j) {
        const double before = slope;
        slope = a * slope + (1 - a) * (x[j] - x[j - 1]) / (t[j] - t[j - 1]);
        out[j] = slope - before;
    }
    return out;
}

/// [from, to) of the samples whose increments form one stretch with a free start.
struct LawStretch {
    std::size_t from = 0, to = 0;
};

std::vector<LawStretch> stretches(const std::vector<char>& used, bool drift) {
    constexpr std::size_t kMaxDriftStretch = 150;
    std::vector<LawStretch> all;
    for (std::size_t j = 0; j < used.size();) {
        if (!used[j]) {
            ++j;
            continue;
        }
        std::size_t to = j;
        while (to < used.size() && used[to]) ++to;
        const std::size_t pieces = drift ? 1 + (to - j) / kMaxDriftStretch : 1, length = (to - j) / pieces;
        for (std::size_t piece = 0; piece < pieces; ++piece, j += length)
            all.push_back({j, piece + 1 == pieces ? to : j + length});
        j = to;
    }
    return all;
}

}  // namespace

LawColumns law_columns(const LawSamples& s, const LawShape& shape) {
    const std::size_t n = s.t.size();
    std::vector<double> y = read_at_samples(s, s.rows_y, shape);
    const std::vector<double> r = s.r.empty() ? std::vector<double>(n, 0.0) : read_at_samples(s, s.rows_r, shape);
    const double middle_r = s.r.empty() ? (y.empty() ? 0 : y.front()) : 0;
    for (double& value : y) value -= middle_r;
    if (shape.filter == LawFilter::measurement && shape.ratio > 0) y = lagged(y, shape.ratio, shape.between);
    const double ratio = shape.filter == LawFilter::derivative ? shape.ratio : 0;
    LawColumns c;
    for (auto& column : c) column.assign(n, 0.0);
    const std::vector<double> dy = slope_moves(y, s.t, ratio, shape.between),
                              dr = slope_moves(r, s.t, ratio, shape.between);
    for (std::size_t j = 1; j < n; ++j) {
        const double h = s.t[j] - s.t[j - 1];
        c[kLawP][j] = y[j - 1] - y[j];
        c[kLawSetPoint][j] = r[j] - r[j - 1];
        c[kLawI][j] = h * (r[j] - 0.5 * (y[j] + y[j - 1]));
        c[kLawD][j] = -dy[j];
        c[kLawSetPointD][j] = dr[j];
        c[kLawTarget][j] = s.u[j] - s.u[j - 1];
    }
    return c;
}

std::vector<char> law_increments(const LawSamples& s, bool with_still) {
    constexpr std::size_t kMinStretch =
        8;                           // increments: in a shorter stretch the free start takes most of the information
    constexpr double kMaxGap = 2.5;  // sample spacings: over a longer gap the integral is not known
    std::vector<char> used(s.t.size(), 0);
    const auto out = [&](std::size_t j) { return s.excluded[j] || s.limited[j] || (!with_still && s.still[j]); };
    for (std::size_t j = 1; j < used.size(); ++j)
        used[j] = !out(j) && !out(j - 1) && s.t[j] - s.t[j - 1] < kMaxGap * s.period;
    for (std::size_t j = 1; j < used.size();) {
        std::size_t to = j;
        while (to < used.size() && used[to]) ++to;
        if (to - j < kMinStretch)
            std::fill(used.begin() + static_cast<long>(j), used.begin() + static_cast<long>(to), 0);
        j = std::max(to, j + 1);
    }
    return used;
}

bool set_point_moves(const LawSamples& s, const std::vector<char>& used) {
    if (s.r.empty()) return false;
    const std::vector<double> r = law_columns(s, {})[kLawSetPoint];
    for (std::size_t j = 0; j < used.size(); ++j)
        if (used[j] && r[j] != 0) return true;
    return false;
}

LawColumns whitened(const LawColumns& columns, const std::vector<char>& used, double theta, bool drift) {
    LawColumns out;
    std::array<bool, kLawColumns> empty = {};
    for (std::size_t c = 0; c < kLawColumns; ++c)
        empty[c] = std::ranges::all_of(columns[c], [](double value) { return value == 0; });
    std::vector<double> trace, line;
    for (const LawStretch& stretch : stretches(used, drift)) {
        // w_0 before the stretch is free: its trace theta^k is taken out of every column, and the line's with it.
        trace.assign(1, 1.0);
        line.assign(1, 0.0);
        for (std::size_t k = stretch.from; k < stretch.to; ++k) {
            trace.push_back(theta * trace.back());
            line.push_back(1 + theta * line.back());
        }
        double norm = 0, along = 0, line_norm = 0;
        for (const double v : trace) norm += v * v;
        for (std::size_t k = 0; k < line.size(); ++k) along += line[k] * trace[k] / norm;
        for (std::size_t k = 0; k < line.size(); ++k) line[k] -= along * trace[k], line_norm += line[k] * line[k];
        for (std::size_t c = 0; c < kLawColumns; ++c) {
            if (empty[c]) continue;
            std::vector<double>& v = out[c];
            const std::size_t from = v.size();
            double state = 0;
            v.push_back(0);
            for (std::size_t k = stretch.from; k < stretch.to; ++k) v.push_back(state = columns[c][k] + theta * state);
            const auto take_out = [&](const std::vector<double>& direction, double square) {
                double share = 0;
                for (std::size_t k = 0; k < direction.size(); ++k) share += direction[k] * v[from + k] / square;
                for (std::size_t k = 0; k < direction.size(); ++k) v[from + k] -= share * direction[k];
            };
            take_out(trace, norm);
            if (drift && line_norm > 0) take_out(line, line_norm);
        }
    }
    return out;
}

std::vector<int> increments_of(const std::vector<char>& used, bool drift) {
    std::vector<int> rows;
    for (const LawStretch& stretch : stretches(used, drift)) {
        rows.push_back(-1);
        for (std::size_t k = stretch.from; k < stretch.to; ++k) rows.push_back(static_cast<int>(k));
    }
    return rows;
}

LawMoments law_moments(const LawColumns& white) {
    LawMoments m = {};
    for (std::size_t a = 0; a < kLawColumns; ++a)
        for (std::size_t b = a; b < kLawColumns; ++b) {
            if (white[a].empty() || white[b].empty()) continue;
            double sum = 0;
            for (std::size_t j = 0; j < white[a].size(); ++j) sum += white[a][j] * white[b][j];
            m[a][b] = m[b][a] = sum;
        }
    return m;
}

LawFit fit_law(const LawMoments& m, const std::vector<int>& chosen) {
    constexpr double kMinPivot = 1e-11;   // of 1: columns that are others' sums to rounding have no coefficients
    constexpr double kPrecision = 1e-15;  // of the moments, over the least pivot: what is left is no smaller
    LawFit out;
    const std::size_t n = chosen.size();
    const auto at = [&](std::size_t i) { return static_cast<std::size_t>(chosen[i]); };
    std::array<double, kLawColumns> scale = {};
    for (std::size_t i = 0; i < n; ++i) {
        const double square = m[at(i)][at(i)];
        if (!(square > 0)) return out;
        scale[i] = 1 / std::sqrt(square);
    }
    // Cholesky's factor L of the scaled moments, and its inverse.
    std::array<std::array<double, kLawColumns>, kLawColumns> L = {}, inverse = {};
    double least_pivot = 1;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k <= i; ++k) {
            double sum = m[at(i)][at(k)] * scale[i] * scale[k];
            for (std::size_t c = 0; c < k; ++c) sum -= L[i][c] * L[k][c];
            if (i == k && !(sum > kMinPivot)) return out;
            L[i][k] = i == k ? std::sqrt(sum) : sum / L[k][k];
            if (i == k) least_pivot = std::min(least_pivot, sum);
        }
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k <= i; ++k) {
            double sum = i == k ? 1 : 0;
            for (std::size_t c = k; c < i; ++c) sum -= L[i][c] * inverse[c][k];
            inverse[i][k] = sum / L[i][i];
        }
    double explained = 0;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < n; ++k) {
            double sum = 0;
            for (std::size_t c = std::max(i, k); c < n; ++c) sum += inverse[c][i] * inverse[c][k];
            out.inverse[at(i)][at(k)] = sum * scale[i] * scale[k];
            out.value[at(i)] += out.inverse[at(i)][at(k)] * m[at(k)][kLawTarget];
        }
    for (std::size_t i = 0; i < n; ++i) explained += out.value[at(i)] * m[at(i)][kLawTarget];
    const double total = m[kLawTarget][kLawTarget];
    out.residual = std::max(kPrecision / least_pivot * total, total - explained);
    out.solved = true;
    return out;
}

}  // namespace tunewright
