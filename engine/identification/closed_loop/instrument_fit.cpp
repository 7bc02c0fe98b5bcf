#include "engine/identification/closed_loop/instrument_fit.h"

#include <algorithm>
#include <cmath>

#include "engine/identification/record/series.h"
#include "engine/numerics/matrix/dense.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNoLength = 1e-12;     ///< length of a column of zeros, as a divisor
constexpr double kNoVariance = 1e-300;  ///< keeps a division by a value near 0 finite

/// The coefficients of 1 + a1 q^-1 + ... with the least Akaike criterion up to order 8, by Levinson and Durbin.
VectorXd whitening(const VectorXd& e) {
    constexpr int kMaxOrder = 8;            // order
    constexpr double kPredictable = 1e-12;  // of the variance: the remainder is rounding
    const Index n = e.size();
    const int max = static_cast<int>(std::min<Index>(kMaxOrder, n / 10));
    VectorXd covariance(max + 1);
    for (int k = 0; k <= max; ++k) covariance[k] = e.head(n - k).dot(e.tail(n - k)) / static_cast<double>(n);
    VectorXd best = VectorXd::Ones(1), a = VectorXd::Ones(1);
    double variance = covariance[0];
    if (!(variance > 0)) return best;
    double min = static_cast<double>(n) * std::log(variance);
    for (int k = 1; k <= max && variance > kPredictable * covariance[0]; ++k) {
        double sum = 0;
        for (int i = 0; i < k; ++i) sum += a[i] * covariance[k - i];
        const double reflection = -sum / variance;
        VectorXd next = VectorXd::Zero(k + 1);
        next.head(k) = a;
        for (int i = 1; i <= k; ++i) next[i] += reflection * a[k - i];
        a = next;
        variance *= 1 - reflection * reflection;
        if (!(variance > 0)) break;
        const double criterion = static_cast<double>(n) * std::log(variance) + 2 * k;
        if (criterion < min) min = criterion, best = a;
    }
    return best;
}

/// The filtered rows, without the first ones up to the filter's order.
MatrixXd filtered(const MatrixXd& X, const VectorXd& a) {
    const Index order = a.size() - 1, n = X.rows() - order;
    MatrixXd out = MatrixXd::Zero(n, X.cols());
    for (Index k = 0; k <= order; ++k) out += a[k] * X.middleRows(order - k, n);
    return out;
}

/// The sensitivities of a model to its parameters for the recorded u (J), and for only the set point's part of u (Z,
/// the instruments); n_samples rows.
class LoopSensitivities {
public:
    LoopSensitivities(const CleanRecord& record, const SetPointPart& part)
        : record_(record), instrument_(driven_by(part, record)), n_(record.samples()) {}

    /// d model/d (searched, linear) with the recorded u, and with the set point's part; and y - model.
    void evaluate(Fit fit) {
        jacobian({&record_, {}}, fit);
        J = columns(fit);
        const auto searched = static_cast<Index>(fit.form.searched().size());
        model = J.rightCols(J.cols() - searched) * Eigen::Map<const VectorXd>(fit.linear.data(), J.cols() - searched);
        e = Eigen::Map<const VectorXd>(record_.y.data(), n_) - model;
        jacobian({&instrument_, {}}, fit);
        Z = columns(fit);
    }

    MatrixXd J, Z;
    VectorXd e, model;

private:
    MatrixXd columns(const Fit& fit) const {
        MatrixXd X(n_, static_cast<Index>(fit.J.size()));
        for (std::size_t k = 0; k < fit.J.size(); ++k)
            X.col(static_cast<Index>(k)) = Eigen::Map<const VectorXd>(fit.J[k].data(), n_);
        return X;
    }

    const CleanRecord& record_;
    CleanRecord instrument_;
    Index n_;
};

/// The filtered problem, with columns of length one and without parameters at their bounds.
struct InstrumentEquations {
    MatrixXd J, Z;
    VectorXd e, length;

    InstrumentEquations(const LoopSensitivities& p, const VectorXd& a, const std::vector<Index>& free) {
        const MatrixXd all_J = filtered(p.J, a), all_Z = filtered(p.Z, a);
        e = filtered(p.e, a);
        J.resize(e.size(), static_cast<Index>(free.size()));
        Z.resize(e.size(), static_cast<Index>(free.size()));
        length.resize(static_cast<Index>(free.size()));
        for (std::size_t k = 0; k < free.size(); ++k) {
            const auto column = static_cast<Index>(k);
            length[column] = std::max(all_Z.col(free[k]).norm(), kNoLength);
            J.col(column) = all_J.col(free[k]) / length[column];
            Z.col(column) = all_Z.col(free[k]) / length[column];
        }
    }
    VectorXd step() const { return solve_square(gram(Z, J), transpose_times(Z, e)).cwiseQuotient(length); }
    /// The part of e in the span of the instruments.
    double merit() const {
        constexpr double kRidge = 1e-9;  // columns have length 1: dependent instruments count only once
        const VectorXd b = transpose_times(Z, e);
        MatrixXd G = gram(Z, Z);
        G.diagonal().array() += kRidge;
        return b.dot(solve_symmetric(G, b));
    }
};

std::vector<Index> free_of(const Fit& fit, const ShapeBounds& bounds, const VectorXd* pushed) {
    std::vector<Index> free;
    const std::vector<int> places = fit.form.searched();
    const auto count = static_cast<Index>(places.size() + fit.linear.size());
    for (Index k = 0; k < count; ++k) {
        if (k < static_cast<Index>(places.size())) {
            const int place = places[static_cast<std::size_t>(k)];
            const double value = fit.shape.p[place];
            const double push = pushed != nullptr ? (*pushed)[k] : 0;
            if ((value <= bounds.low[place] && push <= 0) || (value >= bounds.high[place] && push >= 0)) continue;
        }
        free.push_back(k);
    }
    return free;
}

Fit moved(Fit fit, const ShapeBounds& bounds, const std::vector<Index>& free, const VectorXd& step, double part) {
    const std::vector<int> places = fit.form.searched();
    for (std::size_t k = 0; k < free.size(); ++k) {
        const double by = part * step[static_cast<Index>(k)];
        const auto which = static_cast<std::size_t>(free[k]);
        if (which < places.size()) {
            double& value = fit.shape.p[places[which]];
            value = std::clamp(value + by, bounds.low[places[which]], bounds.high[places[which]]);
        } else {
            fit.linear[which - places.size()] += by;
        }
    }
    return fit;
}

/// Limits a step: no logarithm moves by more than this, no dead time by more than a tenth of the record.
double allowed_part(const Fit& fit, const std::vector<Index>& free, const VectorXd& step) {
    constexpr double kLogarithm = 0.7, kDeadTime = 0.1;  // a factor of 2; of the record
    const std::vector<int> places = fit.form.searched();
    double part = 1;
    for (std::size_t k = 0; k < free.size(); ++k) {
        const auto which = static_cast<std::size_t>(free[k]);
        if (which >= places.size()) continue;
        const double max = is_time(places[which]) ? kDeadTime : kLogarithm;
        const double size = std::abs(step[static_cast<Index>(k)]);
        if (size > max) part = std::min(part, max / size);
    }
    return part;
}

/// Correlation of the set point's filters with the filtered residual.
double mismatch_of(const SetPointPart& part, const InstrumentEquations& here, const VectorXd& a) {
    const auto n = static_cast<Index>(part.filtered.front().size());
    MatrixXd W(n, static_cast<Index>(part.filtered.size()));
    for (std::size_t k = 0; k < part.filtered.size(); ++k)
        W.col(static_cast<Index>(k)) = Eigen::Map<const VectorXd>(part.filtered[k].data(), n);
    W = filtered(W, a);
    W.rowwise() -= W.colwise().mean();
    const VectorXd e = here.e.array() - here.e.mean();
    const VectorXd explained = W * least_squares(W, e);
    const double total = e.squaredNorm();
    if (!(total > 0)) return 0;
    constexpr double kMinUnexplainedShare = 1e-12;  // of the variance: rounding
    const double share = explained.squaredNorm() / total;
    return share / std::max(kMinUnexplainedShare, 1 - share) *
           effective_samples({e.data(), static_cast<std::size_t>(e.size())});
}

/// Variance of the gain, in units of its scaled column, by omitting one part of the record after another (delete-d
/// jackknife: Shao and Wu 1989), because a load that stepped once is not noise over the whole record. A part without
/// which the gain is hardly determined, such as that of a single move of the set point, cannot be compared and is not
/// used.
double jackknife(const InstrumentEquations& here, Index gain) {
    constexpr Index kStretches = 10;
    constexpr double kMaxGainVarianceRatio = 25;  // relative to the gain's variance without the part
    const Index length = here.e.size() / kStretches;
    const MatrixXd A = gram(here.Z, here.J), squares = gram(here.Z, here.Z);
    const VectorXd b = transpose_times(here.Z, here.e);
    const auto variance = [&](const MatrixXd& of_A, const MatrixXd& of_squares) {
        const VectorXd row = inverse_of(of_A).row(gain);
        return row.dot(of_squares * row);
    };
    const double whole = variance(A, squares);
    std::vector<double> moved;
    for (Index k = 0; k < kStretches; ++k) {
        const MatrixXd Z = here.Z.middleRows(k * length, length);
        const MatrixXd rest = A - gram(Z, here.J.middleRows(k * length, length));
        if (!(variance(rest, squares - gram(Z, Z)) < kMaxGainVarianceRatio * whole)) continue;
        moved.push_back(solve_square(rest, b - transpose_times(Z, here.e.segment(k * length, length)))[gain]);
    }
    if (moved.size() < 2) return 0;
    const auto stretches = static_cast<double>(moved.size());
    const double spread = deviation(moved);
    return spread * spread * (stretches - 1) * (stretches - 1) / stretches;
}

/// Variance of the gain, in units of its scaled column, if the residuals count as their number of independent samples.
double gain_variance(const InstrumentEquations& here, Index gain) {
    const auto m = static_cast<double>(here.J.cols());
    if (gain >= here.J.cols()) return 0;
    const double independent = effective_samples({here.e.data(), static_cast<std::size_t>(here.e.size())});
    const VectorXd row = here.Z * inverse_of(gram(here.Z, here.J)).row(gain).transpose();
    const double scale = here.length[gain];
    return here.e.squaredNorm() / std::max(1.0, independent - m) * row.squaredNorm() / (scale * scale);
}

/// Rows: principal axes of the covariance, each of one standard deviation.
std::vector<std::vector<double>> deviations_of(const InstrumentEquations& here, const std::vector<Index>& free,
                                               Index all, double inflation) {
    const auto n = static_cast<double>(here.e.size()), m = static_cast<double>(free.size());
    const double independent = effective_samples({here.e.data(), static_cast<std::size_t>(here.e.size())});
    const double white = here.e.squaredNorm() / n * (n / std::max(1.0, independent - m));
    const MatrixXd inverse = inverse_of(gram(here.Z, here.J));
    const double variance = white * inflation;
    const MatrixXd covariance = variance * inverse * gram(here.Z, here.Z) * inverse.transpose();
    const PrincipalAxes axes = principal_axes(covariance);
    std::vector<std::vector<double>> rows;
    for (Index k = 0; k < covariance.cols(); ++k) {
        const VectorXd axis =
            (std::sqrt(std::max(0.0, axes.values[k])) * axes.vectors.col(k)).cwiseQuotient(here.length);
        std::vector<double> row(static_cast<std::size_t>(all), 0.0);
        for (std::size_t i = 0; i < free.size(); ++i)
            row[static_cast<std::size_t>(free[i])] = axis[static_cast<Index>(i)];
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace

std::optional<InstrumentFit> fit_by_instrument(const CleanRecord& record, const SetPointPart& part, const Fit& start,
                                               const std::stop_token& stop) {
    constexpr int kIterations = 40, kFilterSettles = 4, kHalvings = 8;
    constexpr double kMinStepLength = 1e-6;  // step in standard lengths of the columns
    constexpr double kUsualMismatch = 8;     // usual value by chance
    constexpr double kOfUnfiltered = 0.5;    // of the variance that slow disturbances would cause
    LoopSensitivities rows(record, part);
    const ShapeBounds bounds = shape_bounds(record, start.form.structure);
    Fit fit = start;
    rows.evaluate(fit);
    VectorXd a = whitening(rows.e);
    std::vector<Index> free = free_of(fit, bounds, nullptr);
    for (int iteration = 0; iteration < kIterations && !stop.stop_requested(); ++iteration) {
        if (iteration <= kFilterSettles) a = whitening(rows.e);
        // A parameter at its bound is freed if the equations move it inside.
        std::vector<Index> every(static_cast<std::size_t>(rows.J.cols()));
        for (std::size_t k = 0; k < every.size(); ++k) every[k] = static_cast<Index>(k);
        const VectorXd pushed = InstrumentEquations(rows, a, every).step();
        if (!pushed.allFinite()) return std::nullopt;
        free = free_of(fit, bounds, &pushed);
        const InstrumentEquations here(rows, a, free);
        const VectorXd step = here.step();
        if (!step.allFinite()) return std::nullopt;
        double share = allowed_part(fit, free, step);
        const double merit = here.merit();
        bool better = false;
        for (int half = 0; half < kHalvings && !better; ++half, share /= 2) {
            const Fit next = moved(fit, bounds, free, step, share);
            rows.evaluate(next);
            better = InstrumentEquations(rows, a, free).merit() < merit;
            if (better) fit = next;
        }
        if (!better) rows.evaluate(fit);
        const double length = step.cwiseProduct(here.length).norm() * share;
        if (!better || (iteration > kFilterSettles && length < kMinStepLength)) break;
    }
    const InstrumentEquations here(rows, a, free);
    InstrumentFit out;
    out.mismatch = mismatch_of(part, here, a);
    out.fit = fit;
    out.fit.model.assign(rows.model.begin(), rows.model.end());
    out.fit.residual.assign(rows.e.begin(), rows.e.end());
    out.fit.sse = rows.e.squaredNorm();
    const auto gain = fit.form.searched().size();
    const Index place = std::find(free.begin(), free.end(), static_cast<Index>(gain)) - free.begin();
    // A filter of a few rows cannot whiten the effect of a load over the rest of the record.
    const InstrumentEquations unfiltered(rows, VectorXd::Ones(1), free);
    const double scale = here.length[place], white = std::max(gain_variance(here, place), kNoVariance);
    const double slow =
        std::max(kOfUnfiltered * gain_variance(unfiltered, place), jackknife(here, place) / (scale * scale)) / white;
    out.fit.deviations = deviations_of(here, free, rows.J.cols(), std::max({1.0, out.mismatch / kUsualMismatch, slow}));
    double squares = 0;
    for (const auto& row : out.fit.deviations) squares += row[gain] * row[gain];
    out.gain_error = std::sqrt(squares) / std::max(std::abs(fit.linear[0]), kNoVariance);
    if (!std::isfinite(out.fit.sse) || !std::isfinite(out.gain_error)) return std::nullopt;
    return out;
}

}  // namespace tunewright
