// A noise model of a fit's residual: its strength, its correlation, and the uncertainty of both.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace tunewright {

/// e_k = a_1 e_(k-1) + ... + a_p e_(k-p) + w_k, w white.
struct Autoregression {
    std::vector<double> a;
    double innovation = 0;  ///< standard deviation of w

    /// Variance of e over that of w, and its integrated correlation time in steps, >= 1.
    struct Gains {
        double variance = 1, time = 1;
    };
    Gains gains(std::size_t n) const;
    /// X' R X for the covariance matrix R of such noise; X has one row for each step.
    Eigen::MatrixXd weighed(const Eigen::MatrixXd& X) const;
};

/// The variance of the part of a series that its own past (up to three values) does not predict.
double innovation_variance(std::span<const double> series);

/// Noise in two layers: means over blocks of samples, in which slow noise is separated from changes between samples,
/// and the deviations inside the blocks.
class ResidualNoise {
public:
    /// Each layer by Burg's estimate (Burg 1975; Kay 1988, section 7.4), of an order that Akaike's criterion chooses:
    /// up to 1 for the means, up to 3 inside. Fitting m = `parameters` slow regressors removes slow noise from the
    /// residual: the first order's coefficient is increased by (m + (m + 2) a)/n, which is exact to first order for
    /// polynomials (Kendall 1954 for m = 1). There are at least four means for each parameter. `min`: the variance of
    /// the smallest possible error of y.
    ResidualNoise(std::span<const double> residual, int parameters, double min);

    /// X' R X for the covariance matrix R of the noise; X has one row for each sample.
    Eigen::MatrixXd weighed(const Eigen::MatrixXd& X) const;
    /// Variance of the mean over many samples, times their number.
    double long_run_variance() const { return long_run_; }
    /// Degrees of freedom: independent samples minus parameters, at least 1.
    double freedom() const { return freedom_; }

private:
    Eigen::Index block_ = 1;
    Autoregression slow_, fast_;
    double long_run_ = 0, freedom_ = 1;
};

/// The factor by which 1.96 standard errors with this number of degrees of freedom must be multiplied to contain 95 %:
/// Student's t over the normal quantile, by the first two terms of its expansion (Abramowitz and Stegun 1964, 26.7.5),
/// at 2 degrees for fewer. The expansion is below the exact quantile by 10 % at 2 degrees of freedom, 0.9 % at 5 and
/// 0.1 % at 10; the shares of intervals that contain the true plant (coverage_test.cpp, tests/records) were measured
/// with it.
double student_factor(double freedom);

}  // namespace tunewright
