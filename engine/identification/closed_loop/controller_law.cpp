#include "engine/identification/closed_loop/controller_law.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/identification/closed_loop/set_point_part.h"
#include "engine/numerics/matrix/dense.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

constexpr int kMinLawRows = 40, kMinLawSegment = 10;

/// Rows [from, to) in which u is neither constant at the start nor at an end of its range.
struct MovingRows {
    int from = 0, to = 0;
    int size() const { return to - from; }
};

std::vector<MovingRows> moving_rows(std::span<const double> u) {
    constexpr int kMinHeldRows = 3;
    const auto [low, high] = std::ranges::minmax(u);
    const int n = static_cast<int>(u.size());
    const auto at = [&](int i) { return u[static_cast<std::size_t>(i)]; };
    std::vector<MovingRows> found;
    int from = 0;
    while (from + 1 < n && at(from + 1) == at(0)) ++from;
    if (from < kMinHeldRows) from = 0;
    for (int i = from; i <= n;) {
        int held = i;
        while (held < n && (at(held) == low || at(held) == high) && at(held) == at(i)) ++held;
        if (i < n && held - i < kMinHeldRows) {
            i = std::max(held, i + 1);
            continue;
        }
        if (i - from >= kMinLawSegment) found.push_back({from, i});
        if (i == n) break;
        from = i = held;
    }
    return found;
}

/// Columns: y, the integral of r - y, the set point's contribution (the integral of an unknown one, or r itself),
/// dy/dt; the last column is u. Each segment's mean is subtracted.
Eigen::MatrixXd law_rows(const CleanRecord& record, const std::vector<double>& u, const std::vector<double>& r,
                         const std::vector<MovingRows>& segments) {
    const bool r_moves = !r.empty() && std::ranges::any_of(r, [&](double value) { return value != r.front(); });
    Eigen::Index rows = 0, begin = 0;
    for (const MovingRows& s : segments) rows += s.size();
    const Eigen::Index free = r.empty() || r_moves ? 1 : 0;
    Eigen::MatrixXd X(rows, 4 + free);
    for (const MovingRows& s : segments) {
        double integral = 0;
        for (int i = s.from; i < s.to; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const double dt = i > 0 ? record.t[at] - record.t[at - 1] : 0;
            const double set = r.empty() ? 0 : r[at];
            integral += i > s.from ? (set - record.y[at]) * dt : 0;
            const Eigen::Index row = begin + i - s.from;
            X(row, 0) = record.y[at];
            X(row, 1) = integral;
            if (free > 0) X(row, 2) = r.empty() ? record.t[at] : set;
            X(row, 2 + free) = dt > 0 ? (record.y[at] - record.y[at - 1]) / dt : 0;
            X(row, 3 + free) = u[at];
        }
        auto segment = X.middleRows(begin, s.size());
        segment.rowwise() -= segment.colwise().mean().eval();
        begin += s.size();
    }
    return X;
}

/// The share of the last column's variance that the others do not explain, and their coefficients.
struct Explained {
    Eigen::VectorXd coefficient;
    double left = 1;
};

Explained explain(const Eigen::MatrixXd& X, const Eigen::VectorXd& z) {
    const double total = z.squaredNorm();
    if (!(total > 0) || X.cols() == 0) return {Eigen::VectorXd::Zero(X.cols()), 1};
    const Eigen::VectorXd c = least_squares(X, z);
    return {c, (z - X * c).squaredNorm() / total};
}

/// Explains u by itself: u about its mean as a straight line over time plus a multiple of its first or second integral.
Explained by_integral_of_itself(const CleanRecord& record, const std::vector<double>& u, const MovingRows& rows,
                                int order) {
    Eigen::MatrixXd X(rows.size(), 3);
    Eigen::VectorXd z(rows.size());
    double middle = 0, once = 0, twice = 0;
    for (int i = rows.from; i < rows.to; ++i) middle += u[static_cast<std::size_t>(i)] / rows.size();
    for (int i = rows.from; i < rows.to; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double dt = i > rows.from ? record.t[at] - record.t[at - 1] : 0, before = once;
        once += i > rows.from ? (0.5 * (u[at] + u[at - 1]) - middle) * dt : 0;
        twice += 0.5 * (once + before) * dt;
        X.row(i - rows.from) << 1, record.t[at], order == 1 ? once : twice;
        z[i - rows.from] = u[at] - middle;
    }
    return explain(X, z);
}

/// True if u is two periods or more of a sine about a straight line: u'' = -w^2 u, integrated twice.
bool is_sine(const CleanRecord& record, const std::vector<double>& u, const MovingRows& rows) {
    constexpr double kMaxUnexplainedShare = 0.02, kTwoPeriods = 12.566370614359172;  // share of the variance; radians
    const Explained sine = by_integral_of_itself(record, u, rows, 2);
    const double length =
        record.t[static_cast<std::size_t>(rows.to - 1)] - record.t[static_cast<std::size_t>(rows.from)];
    return sine.left < kMaxUnexplainedShare && sine.coefficient[2] < 0 &&
           std::sqrt(-sine.coefficient[2]) * length > kTwoPeriods;
}

/// Share of u's variance that remains if u is modelled as a lag after one step: u' = a + b u, integrated, plus a
/// straight line. A soft start has this form; a filter of y explains it too, with the noise of y.
double left_by_lagged_step(const CleanRecord& record, const std::vector<double>& u, const MovingRows& rows) {
    return by_integral_of_itself(record, u, rows, 1).left;
}

/// Fits P or PI. PID only if the integral contributes, because a lag's output and its slope alone also explain its
/// input.
Explained law_of(const Eigen::MatrixXd& rows, double plain) {
    constexpr double kMinIntegralVarianceRatio = 4;  // times the variance that the law leaves without its integral
    const Eigen::Index m = rows.cols() - 1;
    const Eigen::VectorXd u = rows.col(m);
    const auto without_integral = [&](Eigen::Index columns) {
        Eigen::MatrixXd less = rows.leftCols(columns);
        less.col(1).setZero();
        return explain(less, u);
    };
    const Explained pi = explain(rows.leftCols(m - 1), u), p = without_integral(m - 1);
    const auto one_sign = [](const Explained& law) { return law.coefficient[0] * law.coefficient[1] <= 0; };
    if (p.left < kMinIntegralVarianceRatio * pi.left && p.left < plain) return p;
    if (pi.left < plain && one_sign(pi)) return pi;
    const Explained pid = explain(rows.leftCols(m), u);
    if (one_sign(pid) && kMinIntegralVarianceRatio * pid.left < without_integral(m).left) return pid;
    return {Eigen::VectorXd::Zero(m), 1};
}

}  // namespace

std::optional<ControllerLaw> controller_law(const CleanRecord& record, const std::vector<double>& u,
                                            const std::vector<double>& r) {
    constexpr double kMaxUnexplainedOfLaw = 0.01;  // of u's variance
    const std::vector<MovingRows> segments = moving_rows(u);
    int rows = 0;
    for (const MovingRows& s : segments) rows += s.size();
    if (rows < kMinLawRows) return std::nullopt;
    const Explained law = law_of(law_rows(record, u, r, segments), kMaxUnexplainedOfLaw);
    if (!(law.left < kMaxUnexplainedOfLaw)) return std::nullopt;
    const MovingRows& longest = *std::ranges::max_element(segments, {}, &MovingRows::size);
    if (is_sine(record, u, longest)) return std::nullopt;
    if (left_by_lagged_step(record, u, longest) <= law.left) return std::nullopt;
    return ControllerLaw{law.coefficient[0], law.coefficient[1], law.left};
}

double left_by_free_plant(const CleanRecord& record, const std::vector<double>& u) {
    std::vector<double> before(u);
    std::rotate(before.rbegin(), before.rbegin() + 1, before.rend());
    before.front() = u.front();
    const std::optional<SetPointPart> plant = set_point_part(record.y, before, u.front());
    return plant ? 1 - plant->share : 0;
}

}  // namespace tunewright
