// Exact steps of z' = F z + G v + c for several inputs v that are cubic within the step, and constant c.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace tunewright {

/// z(h) = Phi z(0) + sum_j Gamma_j v_j + constant with v(s) = sum_j v_j s^j/j!.
struct ManyInputsStep {
    double h = 0;
    Eigen::MatrixXd Phi;
    std::array<Eigen::MatrixXd, 4> Gamma;
    Eigen::VectorXd constant;
    Eigen::MatrixXd all;  ///< [Phi Gamma_0 Gamma_1 Gamma_2 Gamma_3]: one product takes the step

    /// The step of twice the length.
    ManyInputsStep doubled() const;
};

class ManyInputsPropagator {
public:
    ManyInputsPropagator(const Eigen::MatrixXd& F, const Eigen::MatrixXd& G, const Eigen::VectorXd& c, double h0);

    double h0() const { return h0_; }
    /// The step of length h0 2^level, computed once.
    const ManyInputsStep& level(int level);
    /// The states after a step of any length, by Taylor's series: less work for a length that is used once. `input` as
    /// of ManyInputsStep::all; without `constant` for c = 0.
    Eigen::VectorXd after(double h, const Eigen::VectorXd& input, bool constant) const;
    /// A bound of the rates of F, whatever the units of its states.
    double rate() const { return rate_; }

private:
    /// The step of any length, by Taylor's series and doubling.
    ManyInputsStep step(double h) const;

    Eigen::MatrixXd F_, G_;
    Eigen::VectorXd c_;
    double h0_, rate_;
    std::vector<Eigen::MatrixXd> powers_;  // of F, from 0
    std::vector<ManyInputsStep> levels_;
};

}  // namespace tunewright
