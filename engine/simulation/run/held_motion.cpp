#include "engine/simulation/run/held_motion.h"

#include <algorithm>
#include <array>

#include "engine/numerics/matrix/linear_algebra.h"

namespace tunewright {
namespace {
using Index = std::size_t;
}  // namespace

HeldMotion::HeldMotion(const Realisation& plant, double direction, bool with_integral)
    : n_(plant.n + (with_integral ? 1 : 0)),
      A_(Index(n_ * n_), 0.0),
      B_(plant.B),
      C_(plant.C),
      D_(direction * plant.D) {
    for (double& c : C_) c *= direction;
    const int own = plant.n;
    for (int i = 0; i < own; ++i) std::copy_n(plant.A.begin() + i * own, own, A_.begin() + i * n_);
    if (with_integral) {
        std::copy(C_.begin(), C_.end(), A_.begin() + own * n_);
        B_.push_back(D_);
        C_.push_back(0);
    }
    CA_ = row_times(C_, A_);
    CAA_ = row_times(CA_, A_);
    CB_ = dot(C_, B_);
    CAB_ = dot(CA_, B_);
}

HeldStep HeldMotion::step(double h) const {
    const int m = n_ + 1;
    std::vector<double> augmented(Index(m * m), 0.0);
    for (int i = 0; i < n_; ++i) {
        for (int j = 0; j < n_; ++j) augmented[Index(i * m + j)] = A_[Index(i * n_ + j)] * h;
        augmented[Index(i * m + n_)] = B_[Index(i)] * h;
    }
    const std::vector<double> exponential = matrix_exponential(augmented, m);
    HeldStep out{h, std::vector<double>(Index(n_ * n_)), std::vector<double>(Index(n_))};
    for (int i = 0; i < n_; ++i) {
        for (int j = 0; j < n_; ++j) out.Phi[Index(i * n_ + j)] = exponential[Index(i * m + j)];
        out.Gamma[Index(i)] = exponential[Index(i * m + n_)];
    }
    return out;
}

void HeldMotion::advance(const HeldStep& step, double v, std::vector<double>& x) const {
    constexpr int kOnStack = 24;
    std::array<double, kOnStack> small;
    std::vector<double> large;
    double* next = small.data();
    if (n_ > kOnStack) {
        large.resize(Index(n_));
        next = large.data();
    }
    const double* row = step.Phi.data();
    for (int i = 0; i < n_; ++i, row += n_) {
        double sum = step.Gamma[Index(i)] * v;
        for (int j = 0; j < n_; ++j) sum += row[j] * x[Index(j)];
        next[i] = sum;
    }
    std::copy(next, next + n_, x.begin());
}

double HeldMotion::value(const std::vector<double>& x, double v) const { return dot(C_, x) + D_ * v; }

OutputMotion HeldMotion::output(const std::vector<double>& x, double v) const {
    return {value(x, v), dot(CA_, x) + CB_ * v, dot(CAA_, x) + CAB_ * v};
}

std::vector<double> HeldMotion::rate(const std::vector<double>& x, double v) const {
    std::vector<double> out(Index(n_), 0.0);
    multiply(A_, x, out);
    for (int i = 0; i < n_; ++i) out[Index(i)] += B_[Index(i)] * v;
    return out;
}

}  // namespace tunewright
