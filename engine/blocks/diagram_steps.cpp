#include "engine/blocks/diagram_steps.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/matrix/eigenvalues.h"

namespace tunewright {
namespace {

constexpr int kTerms = 14;            // of Taylor's series: 0.5^14/14! is below rounding
constexpr double kLargestTerm = 0.5;  // rate times step
constexpr int kDerivatives = 4;       // of each input, from 0

void put_together(ManyInputsStep& step) {
    const Eigen::Index n = step.Phi.rows(), inputs = step.Gamma[0].cols();
    step.all.resize(n, n + Eigen::Index(step.Gamma.size()) * inputs);
    step.all.leftCols(n) = step.Phi;
    for (std::size_t j = 0; j < step.Gamma.size(); ++j)
        step.all.middleCols(n + Eigen::Index(j) * inputs, inputs) = step.Gamma[j];
}

}  // namespace

ManyInputsStep ManyInputsStep::doubled() const {
    ManyInputsStep out{.h = 2 * h, .Phi = Phi * Phi, .Gamma = {}, .constant = Phi * constant + constant, .all = {}};
    // The second half begins with the derivatives v^(j)(h) = sum_{m >= j} v_m h^(m-j)/(m-j)!.
    for (std::size_t m = 0; m < Gamma.size(); ++m) {
        out.Gamma[m] = Phi * Gamma[m];
        double factor = 1;
        for (std::size_t back = 0; back <= m; ++back) {
            out.Gamma[m] += factor * Gamma[m - back];
            factor *= h / double(back + 1);
        }
    }
    put_together(out);
    return out;
}

ManyInputsPropagator::ManyInputsPropagator(const Eigen::MatrixXd& F, const Eigen::MatrixXd& G, const Eigen::VectorXd& c,
                                           double h0)
    : F_(F), G_(G), c_(c), h0_(h0) {
    const auto n = static_cast<int>(F.rows());
    rate_ = n > 0 ? balanced_norm({F.data(), static_cast<std::size_t>(F.size())}, n) : 0;
    powers_.push_back(Eigen::MatrixXd::Identity(n, n));
    for (int i = 1; i < kTerms; ++i) powers_.push_back(powers_.back() * F_);
}

ManyInputsStep ManyInputsPropagator::step(double h) const {
    const int doublings =
        std::max(0, static_cast<int>(std::ceil(std::log2(std::max(h * rate_ / kLargestTerm, 1e-300)))));
    ManyInputsStep out;
    out.h = std::ldexp(h, -doublings);
    const Eigen::Index n = F_.rows();
    // Psi_j = sum F^i h^(i+j)/(i+j)!, of which Psi_0 is Phi and the next ones take the inputs.
    std::array<Eigen::MatrixXd, 5> Psi;
    double first = 1;
    for (std::size_t j = 0; j < Psi.size(); ++j) {
        Psi[j] = Eigen::MatrixXd::Zero(n, n);
        double term = first;
        for (std::size_t i = 0; i < powers_.size(); ++i) {
            Psi[j] += term * powers_[i];
            term *= out.h / double(i + j + 1);
        }
        first *= out.h / double(j + 1);
    }
    out.Phi = Psi[0];
    for (std::size_t j = 0; j < out.Gamma.size(); ++j) out.Gamma[j] = Psi[j + 1] * G_;
    out.constant = Psi[1] * c_;
    put_together(out);
    for (int i = 0; i < doublings; ++i) out = out.doubled();
    out.h = h;
    return out;
}

Eigen::VectorXd ManyInputsPropagator::after(double h, const Eigen::VectorXd& input, bool constant) const {
    const Eigen::Index n = F_.rows(), inputs = G_.cols();
    const int parts = std::max(1, static_cast<int>(std::ceil(h * rate_ / kLargestTerm)));
    const double part = h / parts;
    Eigen::VectorXd z = input.head(n), term(n), next(n);
    Eigen::MatrixXd v = Eigen::Map<const Eigen::MatrixXd>(input.data() + n, inputs, kDerivatives);
    for (int at = 0; at < parts; ++at) {
        term = z;
        double factor = 1;
        for (int k = 0; k < kTerms; ++k) {
            next.noalias() = F_ * term;
            if (k < kDerivatives) next.noalias() += G_ * v.col(k);
            if (k == 0 && constant) next += c_;
            term.swap(next);
            factor *= part / (k + 1);
            z += factor * term;
        }
        for (int j = 0; j < kDerivatives; ++j) {
            double power = 1;
            for (int i = j + 1; i < kDerivatives; ++i) v.col(j) += (power *= part / (i - j)) * v.col(i);
        }
    }
    return z;
}

const ManyInputsStep& ManyInputsPropagator::level(int level) {
    if (levels_.empty()) levels_.push_back(step(h0_));
    while (static_cast<int>(levels_.size()) <= level) levels_.push_back(levels_.back().doubled());
    return levels_[static_cast<std::size_t>(level)];
}

}  // namespace tunewright
