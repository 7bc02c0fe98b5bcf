#include "engine/identification/closed_loop/set_point_part.h"

#include <algorithm>
#include <cmath>

#include "engine/identification/record/series.h"
#include "engine/numerics/matrix/dense.h"

namespace tunewright {
namespace {

constexpr int kFilters = 8, kPoles = 9;  ///< filters of a Laguerre network; poles that are tried

Eigen::VectorXd low_pass(const Eigen::VectorXd& w, double pole) {
    Eigen::VectorXd x(w.size());
    double state = 0;
    for (Eigen::Index i = 0; i < w.size(); ++i) x[i] = state = pole * state + (1 - pole) * w[i];
    return x;
}

/// (q^-1 - p)/(1 - p q^-1).
Eigen::VectorXd all_pass(const Eigen::VectorXd& w, double pole) {
    Eigen::VectorXd x(w.size());
    double in = 0, out = 0;
    for (Eigen::Index i = 0; i < w.size(); ++i) {
        out = pole * out + in - pole * w[i];
        in = w[i];
        x[i] = out;
    }
    return x;
}

/// 1, w, its moves, and the filters; w is 0 before the first row.
Eigen::MatrixXd regressors(const Eigen::VectorXd& w, double pole) {
    const Eigen::Index n = w.size();
    Eigen::MatrixXd X(n, kFilters + 3);
    X.col(0).setOnes();
    X.col(1) = w;
    X(0, 2) = w[0];
    X.col(2).tail(n - 1) = w.tail(n - 1) - w.head(n - 1);
    Eigen::VectorXd x = low_pass(w, pole);
    for (int k = 0; k < kFilters; ++k) {
        X.col(3 + k) = x;
        x = all_pass(x, pole);
    }
    return X;
}

}  // namespace

std::optional<SetPointPart> set_point_part(const std::vector<double>& u, const std::vector<double>& w, double before) {
    const auto n = static_cast<Eigen::Index>(u.size());
    const Eigen::VectorXd target = Eigen::Map<const Eigen::VectorXd>(u.data(), n);
    Eigen::VectorXd moved = Eigen::Map<const Eigen::VectorXd>(w.data(), n).array() - before;
    const double size = moved.cwiseAbs().maxCoeff();
    if (!(size > 0) || n < 4 * kFilters) return std::nullopt;
    moved /= size;
    const double total = (target.array() - target.mean()).square().sum();
    constexpr double kRidge = 1e-9;  // dependent filters share their coefficients
    double min = -1;
    Eigen::MatrixXd best;
    Eigen::VectorXd coefficient, rest;
    for (int k = 0; k < kPoles; ++k) {
        const double rows = 1.5 * std::pow(static_cast<double>(n) / 9, static_cast<double>(k) / (kPoles - 1));
        const Eigen::MatrixXd X = regressors(moved, std::exp(-1 / rows));
        Eigen::MatrixXd G = gram(X, X);
        G.diagonal() *= 1 + kRidge;
        G.diagonal().array() += kRidge * static_cast<double>(n);
        const Eigen::VectorXd c = solve_symmetric(G, transpose_times(X, target));
        const Eigen::VectorXd left = target - X * c;
        const double sum = left.squaredNorm();
        if (min >= 0 && sum >= min) continue;
        min = sum, best = X, coefficient = c, rest = left;
    }
    constexpr double kMinDivisor = 1e-300, kMinUnexplainedShare = 1e-12;  // keep divisions by values near 0 finite
    SetPointPart part;
    const Eigen::VectorXd explained = best * coefficient;
    for (const double value : explained) part.u.push_back(value - explained[0]);
    for (Eigen::Index k = 1; k < best.cols(); ++k) part.filtered.emplace_back(best.col(k).begin(), best.col(k).end());
    part.share = std::clamp(1 - min / std::max(total, kMinDivisor), 0.0, 1.0);
    const double independent = effective_samples({rest.data(), static_cast<std::size_t>(n)});
    const double freedom = std::max(1.0, independent - kFilters - 3);
    part.strength = part.share * freedom / (std::max(1 - part.share, kMinUnexplainedShare) * (kFilters + 2));
    return part;
}

CleanRecord driven_by(const SetPointPart& part, const CleanRecord& record) {
    CleanRecord driven = record;
    driven.v_time.clear();
    driven.v_level.clear();
    double now = 0;
    for (int i = 0; i < record.samples(); ++i) {
        if (part.u[i] == now) continue;
        if (!driven.v_time.empty() && driven.v_time.back() == record.t[i]) {
            driven.v_level.back() = now = part.u[i];
            continue;
        }
        driven.v_time.push_back(record.t[i]);
        driven.v_level.push_back(now = part.u[i]);
    }
    return driven;
}

}  // namespace tunewright
