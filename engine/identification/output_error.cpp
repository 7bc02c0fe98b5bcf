#include "engine/identification/output_error.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tunewright {
namespace {

/// y0 is an average of many readings in the user's eyes: it counts as ten samples.
constexpr double kRestWeight = 3.1622776601683795;
/// A column whose part outside the others' span is relatively below this is no independent one.
constexpr double kDependent = 1e-9;
constexpr double kStep = 1e-4;

/// Everything known at one shape: the regressors, their orthonormal basis and the projected residual.
struct Projection {
    Eigen::MatrixXd basis;
    Eigen::VectorXd residual, linear;
    bool determined = true;
    double sse = 0;
};

class OutputError {
public:
    OutputError(const CleanRecord& record, const ModelForm& form)
        : record_(record), form_(form), n_(record.samples()), rows_(n_ + (record.y_rest ? 1 : 0)), y_(rows_) {
        for (int i = 0; i < n_; ++i) y_[i] = record.y[i];
        if (record.y_rest) y_[n_] = kRestWeight * *record.y_rest;
    }

    Eigen::MatrixXd regressors(const Shape& shape) {
        respond(shape);
        Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(rows_, form_.linear_size());
        const int gains = form_.gains(), offset = form_.offset_index(), start = form_.start_index();
        for (int i = 0; i < n_; ++i) {
            columns(i, 0) = now_.x[i];
            if (gains == 2) columns(i, 1) = now_.x1[i];
            columns(i, offset) = 1;
            if (form_.start == Start::steady_slope) columns(i, start) = record_.t[i];
            if (form_.start == Start::other_level) columns(i, start) = step_.x[i];
            if (form_.start == Start::other_level && gains == 2) columns(i, start + 1) = step_.x1[i];
        }
        if (record_.y_rest) columns(n_, offset) = kRestWeight;
        return columns;
    }

    Projection project(const Shape& shape) {
        Projection result;
        const Eigen::MatrixXd columns = regressors(shape);
        orthogonalise(columns, result);
        result.sse = result.residual.squaredNorm();
        return result;
    }

    /// d model/d shape, n_rows x shape_size.
    Eigen::MatrixXd sensitivities(const Shape& shape, const Eigen::VectorXd& linear) {
        respond(shape);
        const int np = shape_size(form_.structure), start = form_.start_index();
        const bool zero = form_.gains() == 2, earlier = form_.start == Start::other_level;
        const double K = linear[0], Kb = zero ? linear[1] : 0;
        const double S = earlier ? linear[start] : 0, Sb = earlier && zero ? linear[start + 1] : 0;
        Eigen::MatrixXd D = Eigen::MatrixXd::Zero(rows_, np);
        for (int i = 0; i < n_; ++i) D(i, 0) = -(K * now_.x1[i] + Kb * now_.x2[i]);
        for (int i = 0; earlier && i < n_; ++i) D(i, 0) -= S * step_.x1[i] + Sb * step_.x2[i];
        for (int k = 1; k < np; ++k) {
            for (const double sign : {1.0, -1.0}) {
                Shape moved = shape;
                moved.p[k] += sign * kStep;
                const double weight = sign / (2 * kStep);
                respond(moved);
                for (int i = 0; i < n_; ++i) D(i, k) += weight * (K * now_.x[i] + Kb * now_.x1[i]);
                for (int i = 0; earlier && i < n_; ++i) D(i, k) += weight * (S * step_.x[i] + Sb * step_.x1[i]);
            }
        }
        return D;
    }

    Fit finish(const Shape& shape, const Projection& p) const {
        Fit fit;
        fit.form = form_;
        fit.shape = shape;
        fit.linear.assign(p.linear.begin(), p.linear.end());
        fit.residual.assign(p.residual.begin(), p.residual.begin() + n_);
        fit.model.resize(n_);
        for (int i = 0; i < n_; ++i) fit.model[i] = record_.y[i] - fit.residual[i];
        fit.sse = p.sse;
        fit.determined = p.determined;
        return fit;
    }

private:
    void respond(const Shape& shape) {
        static constexpr double kAtOnce[] = {0}, kUnit[] = {1};
        unit_response(record_.t, {record_.v_time, record_.v_level}, shape, now_);
        if (form_.start == Start::other_level) unit_response(record_.t, {kAtOnce, kUnit}, shape, step_);
    }

    /// Gram-Schmidt with one repetition; the gain's column comes last, so that its independence of the others is what
    /// is judged.
    void orthogonalise(const Eigen::MatrixXd& columns, Projection& result) const {
        const int m = static_cast<int>(columns.cols());
        result.basis = Eigen::MatrixXd::Zero(rows_, m);
        result.linear = Eigen::VectorXd::Zero(m);
        Eigen::MatrixXd R = Eigen::MatrixXd::Zero(m, m);
        Eigen::VectorXd coordinates = Eigen::VectorXd::Zero(m);
        result.residual = y_;
        for (int k = 0; k < m; ++k) {
            Eigen::VectorXd q = columns.col(m - 1 - k);
            const double length = q.norm();
            for (int pass = 0; pass < 2; ++pass) {
                for (int i = 0; i < k; ++i) {
                    const double part = result.basis.col(i).dot(q);
                    R(i, k) += part;
                    q -= part * result.basis.col(i);
                }
            }
            const double rest = q.norm();
            if (!(rest > kDependent * length) || rest < 1e-150) {
                if (k == m - 1) result.determined = false;
                R(k, k) = 1;
                continue;
            }
            R(k, k) = rest;
            result.basis.col(k) = q / rest;
            coordinates[k] = result.basis.col(k).dot(result.residual);
            result.residual -= coordinates[k] * result.basis.col(k);
        }
        const Eigen::VectorXd solution = R.triangularView<Eigen::Upper>().solve(coordinates);
        for (int k = 0; k < m; ++k) result.linear[m - 1 - k] = solution[k];
    }

    const CleanRecord& record_;
    ModelForm form_;
    int n_, rows_;
    Eigen::VectorXd y_;
    UnitResponse now_, step_;
};

Shape clamped(Shape shape, const ShapeBounds& bounds) {
    for (int k = 0; k < shape_size(shape.structure); ++k)
        shape.p[k] = std::clamp(shape.p[k], bounds.low[k], bounds.high[k]);
    return shape;
}

/// Parameters that a step would push through their bound take no part in it.
std::vector<int> free_parameters(const Shape& shape, const ShapeBounds& bounds, const Eigen::VectorXd& descent) {
    std::vector<int> free;
    for (int k = 0; k < descent.size(); ++k) {
        const bool blocked =
            (shape.p[k] <= bounds.low[k] && descent[k] < 0) || (shape.p[k] >= bounds.high[k] && descent[k] > 0);
        if (!blocked) free.push_back(k);
    }
    return free;
}

Eigen::VectorXd damped_step(const Eigen::MatrixXd& normal, const Eigen::VectorXd& descent, const std::vector<int>& free,
                            double lambda) {
    const int m = static_cast<int>(free.size());
    Eigen::MatrixXd A(m, m);
    Eigen::VectorXd b(m);
    const double floor = 1e-12 * normal.diagonal().maxCoeff();
    for (int i = 0; i < m; ++i) {
        for (int j = 0; j < m; ++j) A(i, j) = normal(free[i], free[j]);
        A(i, i) += lambda * std::max(A(i, i), floor);
        b[i] = descent[free[i]];
    }
    const Eigen::VectorXd reduced = A.ldlt().solve(b);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(descent.size());
    for (int i = 0; i < m; ++i) step[free[i]] = reduced[i];
    return step;
}

/// A full step in a logarithm beyond this leaves the region where the linearisation means anything.
Shape moved_by(const Shape& shape, const Eigen::VectorXd& step, const ShapeBounds& bounds) {
    constexpr double kLongest = 1.5;
    double longest = 0;
    for (int k = 1; k < step.size(); ++k) longest = std::max(longest, std::abs(step[k]));
    const double shrink = longest > kLongest ? kLongest / longest : 1;
    Shape next = shape;
    for (int k = 0; k < step.size(); ++k) next.p[k] += shrink * step[k];
    return clamped(next, bounds);
}

double distance(const Shape& a, const Shape& b) {
    double largest = 0;
    for (int k = 0; k < shape_size(a.structure); ++k) largest = std::max(largest, std::abs(a.p[k] - b.p[k]));
    return largest;
}

}  // namespace

ShapeBounds shape_bounds(const CleanRecord& record, Structure structure) {
    const double spacing = 1.0 / std::max(1, record.samples() - 1);
    ShapeBounds bounds;
    bounds.low = {0, std::log(std::min(0.02 * spacing, 1e-3)), std::log(1e-4)};
    bounds.high = {std::max(0.0, record.response_time()), std::log(100.0), std::log(2500.0)};
    if (structure == Structure::ipdt_lag) bounds.high[1] = std::log(10.0);
    // A free run over more than 20 time constants of an unstable plant leaves no digits.
    if (structure == Structure::unstable) bounds.low[1] = std::log(0.05), bounds.high[1] = std::log(10.0);
    return bounds;
}

Fit project(const CleanRecord& record, const ModelForm& form, const Shape& shape) {
    OutputError problem(record, form);
    return problem.finish(shape, problem.project(shape));
}

std::vector<double> sums_of_squares(const CleanRecord& record, const ModelForm& form, const std::vector<Shape>& shapes,
                                    std::stop_token stop) {
    OutputError problem(record, form);
    std::vector<double> sums(shapes.size(), std::numeric_limits<double>::max());
    for (std::size_t i = 0; i < shapes.size() && !stop.stop_requested(); ++i) sums[i] = problem.project(shapes[i]).sse;
    return sums;
}

Fit fit_shape(const CleanRecord& record, const ModelForm& form, const Shape& start, int most_iterations,
              std::stop_token stop) {
    constexpr double kSmallestStep = 1e-9, kSmallestGain = 1e-11, kLargestDamping = 1e10;
    OutputError problem(record, form);
    const ShapeBounds bounds = shape_bounds(record, form.structure);
    Shape shape = clamped(start, bounds);
    Projection here = problem.project(shape);
    double lambda = 1e-3;
    int iteration = 0;
    for (; iteration < most_iterations && here.determined && lambda < kLargestDamping && !stop.stop_requested();
         ++iteration) {
        Eigen::MatrixXd D = problem.sensitivities(shape, here.linear);
        D -= here.basis * (here.basis.transpose() * D);
        const Eigen::VectorXd descent = D.transpose() * here.residual;
        const Eigen::MatrixXd normal = D.transpose() * D;
        const std::vector<int> free = free_parameters(shape, bounds, descent);
        if (free.empty() || !(normal.diagonal().maxCoeff() > 0)) break;
        bool converged = false, better = false;
        while (!better && !converged && lambda < kLargestDamping) {
            const Shape next = moved_by(shape, damped_step(normal, descent, free, lambda), bounds);
            const double moved = distance(next, shape);
            Projection there = problem.project(next);
            converged = !(moved > kSmallestStep);
            better = there.sse < here.sse;
            if (better) {
                converged |= here.sse - there.sse < kSmallestGain * here.sse;
                shape = next;
                here = std::move(there);
                lambda = std::max(1e-9, lambda / 8);
            } else {
                lambda *= 6;
            }
        }
        if (converged) break;
    }
    Fit fit = problem.finish(shape, here);
    fit.iterations = iteration;
    return fit;
}

void jacobian(const CleanRecord& record, Fit& fit) {
    OutputError problem(record, fit.form);
    const Eigen::MatrixXd columns = problem.regressors(fit.shape);
    const Eigen::VectorXd linear =
        Eigen::Map<const Eigen::VectorXd>(fit.linear.data(), static_cast<Eigen::Index>(fit.linear.size()));
    const Eigen::MatrixXd D = problem.sensitivities(fit.shape, linear);
    fit.J.clear();
    for (const Eigen::MatrixXd* part : {&D, &columns}) {
        for (int k = 0; k < part->cols(); ++k) fit.J.emplace_back(part->col(k).begin(), part->col(k).end());
    }
}

}  // namespace tunewright
