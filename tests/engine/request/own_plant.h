// A plant of the test's own, exact between changes of its input, which uses only the description of the plant from the
// engine.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <deque>
#include <stdexcept>
#include <variant>
#include <vector>

#include "engine/plant/plant.h"

namespace tunewright::test {

using Polynomial = std::vector<double>;  // descending powers of s

inline Polynomial times(const Polynomial& a, const Polynomial& b) {
    Polynomial c(a.size() + b.size() - 1, 0.0);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
    return c;
}

struct Fraction {
    Polynomial num, den;
    double L = 0;
};

inline Fraction fraction_of(const Plant& plant) {
    if (const auto* p = std::get_if<Fopdt>(&plant)) return {{p->K}, {p->T, 1}, p->L};
    if (const auto* p = std::get_if<Sopdt>(&plant)) return {{p->K}, times({p->T1, 1}, {p->T2, 1}), p->L};
    if (const auto* p = std::get_if<OscillatorySopdt>(&plant))
        return {{p->K}, {p->T * p->T, 2 * p->zeta * p->T, 1}, p->L};
    if (const auto* p = std::get_if<Ipdt>(&plant))
        return {{p->K}, p->T > 0 ? Polynomial{p->T, 1, 0} : Polynomial{1, 0}, p->L};
    if (const auto* p = std::get_if<TransferFunction>(&plant)) return {p->num, p->den, p->L};
    throw std::invalid_argument("own_plant: no such plant");
}

/// e^M by scaling, Taylor's series and squaring: for the small matrices of this file accurate to rounding.
inline Eigen::MatrixXd own_exponential(Eigen::MatrixXd M) {
    int halvings = 0;
    while (M.cwiseAbs().rowwise().sum().maxCoeff() > 0.25) {
        M /= 2;
        ++halvings;
    }
    Eigen::MatrixXd sum = Eigen::MatrixXd::Identity(M.rows(), M.cols()), term = sum;
    for (int k = 1; k <= 14; ++k) {
        term = term * M / k;
        sum += term;
    }
    while (halvings-- > 0) sum = sum * sum;
    return sum;
}

/// y = P(s) e^(-Ls) (u + d), u held for each sample time after its output, d = `load` from t = 0 on. Strictly proper,
/// at rest at t = 0, when the first sample is read.
class OwnLoopPlant {
public:
    OwnLoopPlant(const Plant& plant, double Ts, double load) : load_(load) {
        const Fraction f = fraction_of(plant);
        const double samples = f.L / Ts;
        whole_ = static_cast<int>(std::floor(samples + 1e-9));
        const double rest = std::max(0.0, f.L - whole_ * Ts);
        n_ = static_cast<int>(f.den.size()) - 1;
        // Time is counted in units in which the poles are near 1; the integral of y is a separate state in the caller's
        // unit.
        double unit = Ts;
        for (int i = 1; i <= n_; ++i)
            if (f.den[static_cast<std::size_t>(i)] != 0)
                unit = std::max(unit, std::pow(std::abs(f.den[0] / f.den[static_cast<std::size_t>(i)]), 1.0 / i));
        Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n_ + 2, n_ + 2);
        const auto scaled = [&](const Polynomial& p, int power) {  // coefficient of s^power in the scaled time
            const int at = static_cast<int>(p.size()) - 1 - power;
            return at < 0 ? 0.0 : p[static_cast<std::size_t>(at)] * std::pow(unit, -power);
        };
        const double lead = scaled(f.den, n_);
        for (int i = 0; i + 1 < n_; ++i) A(i, i + 1) = 1;
        for (int i = 0; i < n_; ++i) A(n_ - 1, i) = -scaled(f.den, i) / lead;
        A(n_ - 1, n_ + 1) = 1;
        C_ = Eigen::RowVectorXd::Zero(n_ + 2);
        for (int i = 0; i < n_; ++i) C_(i) = scaled(f.num, i) / lead;
        A.row(n_) = C_ * unit;
        before_ = {own_exponential(A * (rest / unit)), rest};
        after_ = {own_exponential(A * ((Ts - rest) / unit)), Ts - rest};
        state_ = Eigen::VectorXd::Zero(n_ + 2);
        inputs_.assign(static_cast<std::size_t>(whole_) + 1, 0.0);
    }

    double y() const { return C_ * state_; }
    double iae() const { return iae_; }
    double ise() const { return ise_; }
    double peak() const { return peak_; }  ///< of |y|

    /// P(z) of the samples at z = e^(j angle), 0 < angle <= pi.
    std::complex<double> at(double angle) const {
        const std::complex<double> z = std::polar(1.0, angle);
        const Eigen::MatrixXd Phi = (after_.move * before_.move).topLeftCorner(n_, n_);
        const Eigen::VectorXd late = (after_.move.topLeftCorner(n_, n_) * before_.move.topRightCorner(n_, 1)).col(0),
                              soon = after_.move.topRightCorner(n_, 1).col(0);
        const Eigen::MatrixXcd M = z * Eigen::MatrixXcd::Identity(n_, n_) - Phi.cast<std::complex<double>>();
        const Eigen::VectorXcd into = soon.cast<std::complex<double>>() + late.cast<std::complex<double>>() / z;
        const Eigen::VectorXcd x = M.partialPivLu().solve(into);
        return (C_.leftCols(n_).cast<std::complex<double>>() * x)(0) * std::pow(z, -whole_);
    }

    /// Advances by one sample, with u given at its beginning.
    void step(double u) {
        inputs_.push_back(u + load_);
        const double last = inputs_.front();
        inputs_.pop_front();
        move(before_, last);
        move(after_, inputs_.front());
    }

private:
    struct Piece {
        Eigen::MatrixXd move;
        double time = 0;
    };

    void move(const Piece& piece, double v) {
        if (piece.time <= 0) return;
        const double from = y();
        state_(n_) = 0;
        state_(n_ + 1) = v;
        next_.noalias() = piece.move * state_;
        state_.swap(next_);
        const double to = y();
        ise_ += piece.time * (from * from + from * to + to * to) / 3;
        peak_ = std::max(peak_, std::abs(to));
        if (from * to >= 0)
            iae_ += std::abs(state_(n_));
        else  // a straight line through zero
            iae_ += piece.time * (from * from + to * to) / (2 * std::abs(to - from));
    }

    double load_;
    int n_ = 0, whole_ = 0;
    Piece before_, after_;
    Eigen::VectorXd state_, next_;
    Eigen::RowVectorXd C_;
    std::deque<double> inputs_;  // of the samples that are still delayed, the oldest first
    double iae_ = 0, ise_ = 0, peak_ = 0;
};

}  // namespace tunewright::test
