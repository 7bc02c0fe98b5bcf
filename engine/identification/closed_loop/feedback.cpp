#include "engine/identification/closed_loop/feedback.h"

#include <algorithm>
#include <cmath>

#include "engine/identification/closed_loop/level_law.h"
#include "engine/identification/record/record_kind.h"
#include "engine/numerics/matrix/dense.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

constexpr int kMinMoves = 12;         ///< fewer moves of u do not determine a law
constexpr double kTinyRoot = 1e-150;  ///< keeps a division by a value near 0 finite, also when squared

/// Least squares that is robust against a few outliers, such as moves of the set point.
struct Regression {
    Eigen::VectorXd coefficient, residual;
    std::vector<char> usual;  ///< 1 for rows that are not outliers
    double scale = 0;         ///< deviation of the middle part of the residual
};

double quantile(std::vector<double> values, double part) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// At most a twentieth of the rows is omitted: those with residuals above four deviations.
Regression regress(const Eigen::MatrixXd& X, const Eigen::VectorXd& z) {
    constexpr int kRounds = 6;  // enough in practice for the set of outliers to stop changing
    constexpr double kScaleQuantile = 0.8,
                     kScaleQuantileInDeviations = 1.2816;  // that quantile of |normal|, in standard deviations
    constexpr double kOutlierScales = 4, kMinKeptShare = 0.95;
    constexpr double kRidge = 1e-12;  // of a column's length squared: dependent columns share their coefficient
    const Eigen::Index n = z.size(), m = X.cols();
    Eigen::VectorXd length(m);
    for (Eigen::Index k = 0; k < m; ++k) length[k] = std::max(X.col(k).norm(), kTinyRoot);
    const Eigen::MatrixXd Y = X * length.cwiseInverse().asDiagonal();
    Regression out;
    out.usual.assign(static_cast<std::size_t>(n), 1);
    for (int round = 0; round < kRounds; ++round) {
        Eigen::MatrixXd G = Eigen::MatrixXd::Zero(m, m);
        Eigen::VectorXd b = Eigen::VectorXd::Zero(m);
        for (Eigen::Index i = 0; i < n; ++i) {
            if (out.usual[static_cast<std::size_t>(i)] == 0) continue;
            G.selfadjointView<Eigen::Lower>().rankUpdate(Y.row(i).transpose());
            b += z[i] * Y.row(i).transpose();
        }
        G.diagonal().array() += kRidge;
        const Eigen::VectorXd scaled = solve_symmetric(G, b);
        out.residual = z - Y * scaled;
        out.coefficient = scaled.cwiseQuotient(length);
        const Eigen::VectorXd size = out.residual.cwiseAbs();
        const std::vector<double> sizes(size.begin(), size.end());
        out.scale = quantile(sizes, kScaleQuantile) / kScaleQuantileInDeviations;
        const double limit = std::max(kOutlierScales * out.scale, quantile(sizes, kMinKeptShare));
        for (std::size_t i = 0; i < sizes.size(); ++i) out.usual[i] = sizes[i] <= limit ? 1 : 0;
    }
    return out;
}

/// Root mean squares of two regressions of the same z over the rows that are usual in both.
struct Errors {
    double a = 0, b = 0;
    double ratio() const { return b / std::max(a, kTinyRoot); }
};

Errors compare(const Regression& a, const Regression& b) {
    Errors out;
    int n = 0;
    for (std::size_t i = 0; i < a.usual.size(); ++i) {
        if (a.usual[i] == 0 || b.usual[i] == 0) continue;
        const auto row = static_cast<Eigen::Index>(i);
        out.a += a.residual[row] * a.residual[row];
        out.b += b.residual[row] * b.residual[row];
        ++n;
    }
    out.a = std::sqrt(out.a / std::max(1, n));
    out.b = std::sqrt(out.b / std::max(1, n));
    return out;
}

/// The selected rows, and the changes between them.
struct Moves {
    bool every_row = true;
    std::vector<int> row;
    std::vector<double> du, dy, dy_before, area, area_before, dt;

    int size() const { return static_cast<int>(row.size()); }
};

Moves moves_of(const CleanRecord& r, const std::vector<double>& u, int moved) {
    Moves m;
    m.every_row = 2 * moved >= r.samples();
    int from = 0;
    double area = 0;
    for (int i = 0; i < r.samples(); ++i) {
        if (i > 0) area += (0.5 * (r.y[i] + r.y[i - 1]) - r.y[0]) * (r.t[i] - r.t[i - 1]);
        if (i > 0 && !m.every_row && u[i] == u[i - 1]) continue;
        const int last = std::max(0, i - 1), last_from = std::max(0, from - 1);
        m.row.push_back(i);
        m.du.push_back(u[i] - u[from]);
        m.dy.push_back(r.y[i] - r.y[from]);
        m.dy_before.push_back(r.y[last] - r.y[last_from]);
        m.area.push_back(area);
        m.area_before.push_back(i > 0 ? area - (0.5 * (r.y[i] + r.y[last]) - r.y[0]) * (r.t[i] - r.t[last]) : 0);
        m.dt.push_back(r.t[i] - r.t[from]);
        from = i, area = 0;
    }
    return m;
}

/// Predictions of u's moves from u's own past, from y up to the same row, and from y of the earlier rows.
struct Predictions {
    Regression by_u, by_y, by_past_y;
    int coefficients = 0, first = 0, y_column = 0;  ///< first: index of the first move predicted
};

double rate(const Moves& m, int j) { return m.dt[j] > 0 ? m.du[j] / m.dt[j] : 0; }

/// Predictions of a move from the moves before it where the rows are unevenly spaced: `carried_on` at the last rate of
/// u, `bent_on` at the last change of that rate.
double carried_on(const Moves& m, int j) { return rate(m, j - 1) * m.dt[j]; }
double bent_on(const Moves& m, int j) {
    const double apart = m.dt[j - 1] + m.dt[j - 2];
    return apart > 0 ? (rate(m, j - 1) - rate(m, j - 2)) / apart * m.dt[j] * (m.dt[j] + m.dt[j - 1]) : 0;
}

/// True for ramps and slewing valves: most moves continue at the rate of the previous move.
bool on_ramps(const Moves& m) {
    constexpr double kRateTolerance = 1e-3,
                     kMaxSameShare = 0.6;  // relative rounding of logged values; share of the moves
    int same = 0, moved = 0;
    for (int j = 2; j < m.size(); ++j) {
        if (m.du[j] == 0) continue;
        ++moved;
        same += std::abs(rate(m, j) - rate(m, j - 1)) <= kRateTolerance * std::abs(rate(m, j)) ? 1 : 0;
    }
    return same > kMaxSameShare * moved;
}

Predictions predict_every_row(const Moves& m) {
    constexpr int kOwnLags = 12, kShortLags = 4, kFirstRow = kOwnLags + 2;
    const int n = m.size() - kFirstRow;
    Eigen::MatrixXd own(n, kOwnLags + 2), same(n, kOwnLags + 2), past(n, kOwnLags + 2);
    Eigen::VectorXd z(n);
    for (int i = 0; i < n; ++i) {
        const int j = i + kFirstRow;
        z[i] = m.du[j];
        own(i, kOwnLags) = same(i, kOwnLags) = past(i, kOwnLags) = carried_on(m, j);
        own(i, kOwnLags + 1) = same(i, kOwnLags + 1) = past(i, kOwnLags + 1) = bent_on(m, j);
        for (int l = 0; l < kOwnLags; ++l) own(i, l) = m.du[j - 1 - l];
        for (int l = 0; l < kShortLags; ++l) same(i, l) = past(i, l) = m.du[j - 1 - l];
        for (int l = 0; l < kOwnLags - kShortLags; ++l) {
            same(i, kShortLags + l) = m.dy[j - l];
            past(i, kShortLags + l) = m.dy[j - 1 - l];
        }
    }
    return {regress(own, z), regress(same, z), regress(past, z), kOwnLags, kFirstRow, kShortLags};
}

/// From one move of u to the next: the differences of y and its integral, for a PI law that rests between its moves.
Predictions predict_moves(const Moves& m) {
    constexpr int kFewMoves = 60;
    const bool few = m.size() < kFewMoves;
    const int lags = few ? 3 : 7, kept = few ? 1 : 3, columns = lags + 2, first = lags + 2, n = m.size() - first;
    Eigen::MatrixXd own(n, columns), same(n, columns), past(n, columns);
    Eigen::VectorXd z(n);
    for (int i = 0; i < n; ++i) {
        const int j = i + first;
        z[i] = m.du[j];
        for (int l = 0; l < lags; ++l) own(i, l) = m.du[j - 1 - l];
        for (int l = 0; l < kept; ++l) same(i, l) = past(i, l) = m.du[j - 1 - l];
        own(i, lags) = m.dt[j], own(i, lags + 1) = few ? 1 : m.dt[j - 1];
        int k = kept;
        same(i, k) = m.dy[j], past(i, k++) = m.dy_before[j];
        same(i, k) = m.area[j], past(i, k++) = m.area_before[j];
        same(i, k) = past(i, k) = m.dt[j], ++k;
        if (few) {
            same(i, k) = past(i, k) = 1;
        } else {
            same(i, k) = past(i, k) = m.dt[j - 1], ++k;
            same(i, k) = past(i, k) = m.dy[j - 1], ++k;
            same(i, k) = past(i, k) = m.area[j - 1];
        }
    }
    return {regress(own, z), regress(same, z), regress(past, z), columns, first, kept};
}

/// Predictions of y from y's past alone, and from the past of both.
struct NewsOfY {
    Regression by_y, by_both;
    int first = 0;
};

NewsOfY news_of_y(const CleanRecord& r, const std::vector<double>& u) {
    constexpr int kOwnLags = 12, kShortLags = 4, kFirstRow = kOwnLags + 2;
    const int n = r.samples() - kFirstRow;
    Eigen::MatrixXd own(n, kOwnLags), both(n, kOwnLags);
    Eigen::VectorXd z(n);
    auto dy = [&](int i) { return r.y[i] - r.y[i - 1]; };
    for (int i = 0; i < n; ++i) {
        const int j = i + kFirstRow;
        z[i] = dy(j);
        for (int l = 0; l < kOwnLags; ++l) own(i, l) = dy(j - 1 - l);
        for (int l = 0; l < kShortLags; ++l) both(i, l) = own(i, l);
        for (int l = 0; l < kOwnLags - kShortLags; ++l) both(i, kShortLags + l) = u[j - 1 - l] - u[j - 2 - l];
    }
    return {regress(own, z), regress(both, z), kFirstRow};
}

/// The part of u's innovations (its moves that its past does not predict) that y's innovations (not predicted by the
/// past of both) leave unexplained, as a ratio of root mean squares. In an open-loop test with a clean y and a noisy
/// reading of u, y predicts u, but its innovations do not.
double unexplained_by_news(const Moves& m, const Predictions& p, const NewsOfY& y) {
    constexpr int kLags = 6;
    const auto n = static_cast<int>(p.by_u.residual.size()) - kLags;
    Eigen::MatrixXd X(n, kLags + 1);
    Eigen::VectorXd z(n);
    const auto news = [&](int row) {
        return row >= y.first && row < y.first + y.by_both.residual.size() ? y.by_both.residual[row - y.first] : 0.0;
    };
    for (int i = 0; i < n; ++i) {
        z[i] = p.by_u.residual[i + kLags];
        for (int l = 0; l <= kLags; ++l) X(i, l) = news(m.row[i + kLags + p.first] - l);
    }
    const Errors errors = compare(regress(Eigen::MatrixXd::Zero(n, 1), z), regress(X, z));
    return errors.ratio();
}

/// If a logger writes u after y has responded to it, y and u of the same row look as with a controller. But the law of
/// a plant is a lag with a gain; that of a controller has no lag of y or, with integral action, no gain from u to y.
bool is_law_of_lag(const CleanRecord& r, const std::vector<double>& u) {
    constexpr double kMaxLagCoefficient = 0.2,
                     kMaxGainCoefficient = 0.7;  // a controller's law has smaller coefficients
    const int n = r.samples() - 2;
    Eigen::MatrixXd X(n, 3);
    Eigen::VectorXd z(n);
    for (int i = 0; i < n; ++i) {
        const int j = i + 2;
        z[i] = r.y[j] - r.y[j - 1];
        X.row(i) << r.y[j - 1] - r.y[j - 2], u[j] - u[j - 1], u[j - 1] - u[j - 2];
    }
    const Eigen::VectorXd c = regress(X, z).coefficient;
    return c[0] > kMaxLagCoefficient && std::abs(c[1] + c[2]) > kMaxGainCoefficient * std::abs(c[1]);
}

bool on_few_levels(std::vector<double> u) {
    constexpr double kLevelTolerance = 1e-3;  // of u's range: jitter of a level
    constexpr int kMaxLevels = 3;
    std::sort(u.begin(), u.end());
    const double same = kLevelTolerance * (u.back() - u.front());
    int levels = 1;
    double last = u.front();
    for (const double value : u) {
        if (value - last > same) ++levels;
        if (value - last > same) last = value;
    }
    return levels <= kMaxLevels;
}

/// True for a pseudo-random sequence or a heater with pulse width modulation, with any jitter or grid of u.
bool switches_between_two(const CleanRecord& r) { return two_levels(input_levels(r)).switch_time.size() >= 3; }

/// Moves that the controller's law does not explain, much larger than its other residuals; of several successive ones
/// only the first.
std::vector<OutsideMove> outside_moves(const CleanRecord& r, const Moves& m, const Predictions& p) {
    constexpr double kMinResidualScales = 10,
                     kMinShareOfRange = 0.01;  // standard deviations of the law's residual; of u's range
    constexpr int kMinMovesBetween = 8;        // moves between two of them that count separately
    const double law = p.by_y.coefficient[p.y_column];
    std::vector<OutsideMove> found;
    if (law == 0) return found;
    int last = -kMinMovesBetween;
    for (Eigen::Index i = 0; i < p.by_y.residual.size(); ++i) {
        const double left = p.by_y.residual[i];
        if (std::abs(left) < std::max(kMinResidualScales * p.by_y.scale, kMinShareOfRange)) continue;
        const int j = static_cast<int>(i) + p.first;
        if (j - last >= kMinMovesBetween) found.push_back({r.t[m.row[j]], -left / law});
        last = j;
    }
    return found;
}

/// The record's moves, if a controller could have made them.
std::optional<Moves> possible_moves(const CleanRecord& r, const std::vector<double>& u) {
    if (r.changes() < kMinMoves || r.samples() < 3 * kMinMoves) return std::nullopt;
    const RecordKind kind = r.kind == RecordKind::automatic ? found_kind(r) : r.kind;
    if (kind == RecordKind::relay || on_few_levels(u) || switches_between_two(r)) return std::nullopt;
    int moved = 0;
    for (int i = 1; i < r.samples(); ++i) moved += u[i] != u[i - 1] ? 1 : 0;
    Moves moves = moves_of(r, u, moved);
    if (moves.size() < 2 * kMinMoves || on_ramps(moves)) return std::nullopt;
    return moves;
}

std::optional<Feedback> found_in_moves(const CleanRecord& r, const std::vector<double>& u, const Moves& moves) {
    constexpr double kMinOwnError = 1e-6;         // of u's range: u is predicted by its own past except for rounding
    constexpr double kMaxExactErrorRatio = 0.03;  // ratio of errors below that of any open-loop test
    constexpr double kMoreThanChance = 1.6;       // standard errors of the log ratio; more for uneven rows
    constexpr double kMoreUneven = 3;
    constexpr double kNewsInY = 0.8;                // u's past must not lower y's error below this share
    constexpr double kByNews = 0.3;                 // share of y's explanation of u's moves that its innovations must
                                                    // explain
    constexpr double kMinYError = 3e-4;             // of y's range: a y with a smaller error is a simulation's
    constexpr double kMaxPlainLawErrorRatio = 0.5;  // ratio of errors at which the outliers are moves of the set point
    const Predictions p = moves.every_row ? predict_every_row(moves) : predict_moves(moves);
    const Errors same = compare(p.by_u, p.by_y), past = compare(p.by_u, p.by_past_y);
    if (same.a < kMinOwnError) return std::nullopt;
    const bool at_once = same.ratio() <= past.ratio();
    const double ratio = std::min(same.ratio(), past.ratio());
    const auto n = static_cast<double>(p.by_u.residual.size());
    const double margin = moves.every_row && unevenly_spaced(r) ? kMoreUneven : kMoreThanChance;
    if (ratio > std::exp(-margin * std::sqrt(p.coefficients / n))) return std::nullopt;
    const bool exact = ratio < kMaxExactErrorRatio;
    if (!exact || !moves.every_row) {
        const NewsOfY y = news_of_y(r, u);
        const Errors of_y = compare(y.by_y, y.by_both);
        if (of_y.b < kMinYError) return std::nullopt;
        if (!exact && of_y.ratio() < kNewsInY) return std::nullopt;
        const double left = unexplained_by_news(moves, p, y);
        if (!exact && 1 - left * left < kByNews * (1 - ratio * ratio)) return std::nullopt;
    }
    if (at_once && moves.every_row && !exact && is_law_of_lag(r, u)) return std::nullopt;
    Feedback feedback{same.a, at_once ? same.b : past.b, at_once, 0, {}};
    if (same.ratio() < kMaxPlainLawErrorRatio) {
        feedback.gain = p.by_y.coefficient[p.y_column];
        feedback.outside = outside_moves(r, moves, p);
    }
    return feedback;
}

}  // namespace

std::vector<double> input_at_samples(const CleanRecord& r) {
    std::vector<double> u;
    int change = 0;
    double v = 0;
    for (const double t : r.t) {
        for (; change < r.changes() && r.v_time[change] <= t; ++change) v = r.v_level[change];
        u.push_back(v);
    }
    return u;
}

bool may_be_controlled(const CleanRecord& r) { return possible_moves(r, input_at_samples(r)).has_value(); }

double restlessness(const CleanRecord& r) {
    constexpr double kMinMovingShare = 0.1;  // of the rows: tests move u in fewer rows
    const std::vector<double> u = input_at_samples(r);
    const std::optional<Moves> moves = possible_moves(r, u);
    if (!moves || moves->size() < kMinMovingShare * r.samples() || is_law_of_lag(r, u)) return 0;
    const Predictions p = moves->every_row ? predict_every_row(*moves) : predict_moves(*moves);
    return compare(p.by_u, p.by_u).a / std::max(deviation(u), kTinyRoot);
}

std::optional<Feedback> find_feedback(const CleanRecord& r) {
    const std::vector<double> u = input_at_samples(r);
    const std::optional<Moves> moves = possible_moves(r, u);
    if (!moves) return std::nullopt;
    if (auto found = found_in_moves(r, u, *moves)) return found;
    const std::optional<LevelLaw> law = level_law(r, u);
    if (!law) return std::nullopt;
    return Feedback{deviation(u), law->left, true, law->gain, {}};
}

}  // namespace tunewright
