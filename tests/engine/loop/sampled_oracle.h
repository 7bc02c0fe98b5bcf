// A second implementation of the sampled loop, written only from the descriptions in
// engine/controller/sampled/sampled_pid.h and engine/loop/README.md: its own realisation, its own exponential, its own
// queue of delayed outputs, and the difference equations of the law as documented. It uses no code of the product.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <deque>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "engine/controller/sampled/sampled_pid.h"

namespace tunewright::test {

using Coefficients = std::vector<double>;  // descending powers

inline Coefficients times(const Coefficients& a, const Coefficients& b) {
    Coefficients c(a.size() + b.size() - 1, 0.0);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
    return c;
}

/// gain times prod (s - root).
inline Coefficients with_roots(const std::vector<std::complex<double>>& roots, double gain) {
    std::vector<std::complex<double>> c{gain};
    for (const auto root : roots) {
        c.emplace_back(0.0);
        for (std::size_t i = c.size() - 1; i > 0; --i) c[i] -= root * c[i - 1];
    }
    Coefficients real(c.size());
    for (std::size_t i = 0; i < c.size(); ++i) real[i] = c[i].real();
    return real;
}

/// num(s)/den(s) in the canonical form of controllability: x' = A x + B v, y = C x + D v.
class OwnPlant {
public:
    OwnPlant() = default;
    OwnPlant(const Coefficients& num, const Coefficients& den) {
        n_ = den.size() - 1;
        Coefficients b(n_ + 1, 0.0);
        for (std::size_t i = 0; i < num.size(); ++i) b[n_ + 1 - num.size() + i] = num[i] / den[0];
        D_ = b[0];
        A_.assign(n_ * n_, 0.0);
        for (std::size_t i = 0; i + 1 < n_; ++i) A_[i * n_ + i + 1] = 1;
        for (std::size_t j = 0; j < n_; ++j) {
            const double a = den[n_ - j] / den[0];
            A_[(n_ - 1) * n_ + j] = -a;
            C_.push_back(b[n_ - j] - D_ * a);
        }
    }

    /// The motion of the states over h with v constant: x(h) = Phi x + Gamma v. Taylor's series of [A h, B h; 0, 0]
    /// 2^-m in long double, squared m times.
    struct Motion {
        std::vector<double> Phi, Gamma;
    };
    Motion over(double h) const {
        const std::size_t s = n_ + 1;
        std::vector<long double> M(s * s, 0.0L);
        long double norm = 0;
        for (std::size_t i = 0; i < n_; ++i)
            for (std::size_t j = 0; j < n_; ++j) M[i * s + j] = static_cast<long double>(A_[i * n_ + j]) * h;
        if (n_ > 0) M[(n_ - 1) * s + n_] = h;
        for (const long double m : M) norm += std::abs(m);
        int halvings = 0;
        for (; norm > 0.25L; norm /= 2) ++halvings;
        for (long double& m : M) m = std::ldexp(m, -halvings);
        std::vector<long double> sum = identity(s), term = sum;
        for (int k = 1; k < 22; ++k) {
            term = product(term, M, s);
            for (long double& t : term) t /= k;
            for (std::size_t i = 0; i < s * s; ++i) sum[i] += term[i];
        }
        for (; halvings > 0; --halvings) sum = product(sum, sum, s);
        Motion motion;
        for (std::size_t i = 0; i < n_; ++i) {
            for (std::size_t j = 0; j < n_; ++j) motion.Phi.push_back(static_cast<double>(sum[i * s + j]));
            motion.Gamma.push_back(static_cast<double>(sum[i * s + n_]));
        }
        return motion;
    }
    static void move(const Motion& m, std::vector<double>& x, double v) {
        std::array<double, 24> next;
        const std::size_t n = x.size();
        for (std::size_t i = 0; i < n; ++i) {
            next[i] = m.Gamma[i] * v;
            for (std::size_t j = 0; j < n; ++j) next[i] += m.Phi[i * n + j] * x[j];
        }
        std::copy_n(next.begin(), n, x.begin());
    }

    std::size_t order() const { return n_; }
    double output(const std::vector<double>& x, double v) const {
        double y = D_ * v;
        for (std::size_t i = 0; i < n_; ++i) y += C_[i] * x[i];
        return y;
    }

private:
    static std::vector<long double> identity(std::size_t s) {
        std::vector<long double> one(s * s, 0.0L);
        for (std::size_t i = 0; i < s; ++i) one[i * s + i] = 1;
        return one;
    }
    static std::vector<long double> product(const std::vector<long double>& a, const std::vector<long double>& b,
                                            std::size_t s) {
        std::vector<long double> c(s * s, 0.0L);
        for (std::size_t i = 0; i < s; ++i)
            for (std::size_t k = 0; k < s; ++k)
                for (std::size_t j = 0; j < s; ++j) c[i * s + j] += a[i * s + k] * b[k * s + j];
        return c;
    }

    std::size_t n_ = 0;
    std::vector<double> A_, C_;
    double D_ = 0;
};

/// The states and equations of the law, in the order of the comment in sampled_pid.h.
struct OwnLaw {
    SampledPid law;
    double y_f = 0, v = 0, D = 0, I = 0, e_last = 0;
    std::vector<double> f_last;  // f_{k-1}, f_{k-2}, ...

    explicit OwnLaw(const SampledPid& of) : law(of), f_last(std::max<std::size_t>(3, std::size_t(of.slope_samples))) {}

    double step(double r, double y) {
        const ParallelPid& g = law.gains;
        const double Ts = law.Ts, Tf = g.filter.Tf;
        if (g.filter.type == FilterType::measurement_first_order) {
            y_f = (Tf * y_f + Ts * y) / (Tf + Ts);
        } else if (g.filter.type == FilterType::measurement_second_order) {
            v = (v + (2 * Ts / (Tf * Tf)) * (y - y_f)) / (1 + 2 * Ts / Tf + 2 * std::pow(Ts / Tf, 2));
            y_f += Ts * v;
        } else {
            y_f = y;
        }
        const double e = r - y_f, f = g.c * r - y_f;
        if (law.integral == IntegralRule::backward) I += g.Ki * Ts * e;
        if (law.integral == IntegralRule::forward) I += g.Ki * Ts * e_last;
        if (law.integral == IntegralRule::trapezoidal) I += g.Ki * Ts * (e + e_last) / 2;
        const double difference = g.Kd * (f - f_last[0]) / Ts;
        const bool filtered = g.filter.type == FilterType::derivative;
        switch (law.derivative) {
            case DerivativeRule::difference: D = difference; break;
            case DerivativeRule::filtered_backward:
                D = filtered ? (Tf * D + g.Kd * (f - f_last[0])) / (Tf + Ts) : difference;
                break;
            case DerivativeRule::filtered_forward:
                D = filtered ? (1 - Ts / Tf) * D + g.Kd * (f - f_last[0]) / Tf : difference;
                break;
            case DerivativeRule::filtered_trapezoidal:
                D = filtered ? ((2 * Tf - Ts) * D + 2 * g.Kd * (f - f_last[0])) / (2 * Tf + Ts) : difference;
                break;
            case DerivativeRule::slope:
                D = g.Kd * (f - f_last[std::size_t(law.slope_samples) - 1]) / (law.slope_samples * Ts);
                break;
            case DerivativeRule::four_points:
                D = g.Kd * (3 * f + f_last[0] - f_last[1] - 3 * f_last[2]) / (10 * Ts);
                break;
        }
        f_last.insert(f_last.begin(), f);
        f_last.pop_back();
        e_last = e;
        return g.Kp * (g.b * r - y_f) + I + D;
    }
};

/// Plant and law from sample to sample, with all states: the loop without external inputs.
class OwnLoop {
public:
    OwnLoop(const OwnPlant& plant, double dead_time, const SampledPid& law)
        : plant_(plant), law_(law), x_(plant.order(), 0.0) {
        const double in_samples = (dead_time + law.computation_delay) / law.Ts;
        whole_ = static_cast<std::size_t>(in_samples + 1e-9);
        const double rest = in_samples - static_cast<double>(whole_);
        split_ = rest > 1e-9;
        before_ = plant.over(split_ ? rest * law.Ts : law.Ts);
        if (split_) after_ = plant.over((1 - rest) * law.Ts);
        on_the_way_.assign(whole_ + 1, 0.0);
    }

    double y() const { return plant_.output(x_, on_the_way_.front()); }  ///< just before the output changes
    /// One period; the law reads y + n. Returns u.
    double step(double n) {
        const double u = law_.step(0, y() + n);
        const double oldest = on_the_way_.front();
        on_the_way_.pop_front();
        on_the_way_.push_back(u);
        if (split_) OwnPlant::move(before_, x_, oldest);
        OwnPlant::move(split_ ? after_ : before_, x_, on_the_way_.front());
        return u;
    }

    /// The eigenvalues of one period as a matrix: the images of all unit vectors.
    Eigen::VectorXcd eigenvalues() {
        const std::vector<double> saved = memory();
        const Eigen::Index m = static_cast<Eigen::Index>(saved.size());
        Eigen::MatrixXd matrix(m, m);
        for (Eigen::Index j = 0; j < m; ++j) {
            std::vector<double> unit(saved.size(), 0.0);
            unit[std::size_t(j)] = 1;
            set_memory(unit);
            step(0);
            const std::vector<double> image = memory();
            for (Eigen::Index i = 0; i < m; ++i) matrix(i, j) = image[std::size_t(i)];
        }
        set_memory(saved);
        return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
    }

private:
    // Without states that affect nothing: one that only integrates, or is only held, would be an eigenvalue of its own.
    std::vector<double> memory() const {
        std::vector<double> all = x_;
        const auto add = [&](const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
        add(on_the_way_);
        const ParallelPid& g = law_.law.gains;
        if (g.Ki != 0) all.insert(all.end(), {law_.I, law_.e_last});
        if (g.Kd != 0) {
            add(law_.f_last);
            all.push_back(law_.D);
        }
        all.push_back(law_.y_f);
        if (g.filter.type == FilterType::measurement_second_order) all.push_back(law_.v);
        return all;
    }
    void set_memory(const std::vector<double>& all) {
        auto next = all.begin();
        const auto take = [&](auto& values) {
            std::copy_n(next, values.size(), values.begin());
            next += static_cast<std::ptrdiff_t>(values.size());
        };
        take(x_);
        take(on_the_way_);
        const ParallelPid& g = law_.law.gains;
        law_.I = g.Ki != 0 ? *next++ : 0;
        law_.e_last = g.Ki != 0 ? *next++ : 0;
        if (g.Kd != 0) {
            take(law_.f_last);
            law_.D = *next++;
        }
        law_.y_f = *next++;
        law_.v = g.filter.type == FilterType::measurement_second_order ? *next++ : 0;
    }

    OwnPlant plant_;
    OwnLaw law_;
    std::vector<double> x_;
    std::deque<double> on_the_way_;  // u, the latest last: the first one drives the plant at the beginning of a period
    std::size_t whole_ = 0;
    bool split_ = false;
    OwnPlant::Motion before_, after_;
};

}  // namespace tunewright::test
