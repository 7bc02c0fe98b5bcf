#include "engine/simulation/relay/relay_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kStepsPerRadian = 10;
constexpr double kDecay = 25;                   // e^-25 = 1e-11
constexpr double kMaxRelativeRealPart = 1e-10;  // of |p|: real part of a pole that neither decays nor grows
constexpr int kLevels = 60;
constexpr double kExtremumTolerance = 1e-15;  // of the step

}  // namespace

Quintic::Quintic(double h, const OutputMotion& start, const OutputMotion& end) : h_(h) {
    const double rise = end.y - start.y, v0 = h * start.slope, v1 = h * end.slope;
    const double a0 = h * h * start.curvature, a1 = h * h * end.curvature;
    c_ = {start.y,
          v0,
          a0 / 2,
          10 * rise - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1,
          -15 * rise + 8 * v0 + 7 * v1 + 1.5 * a0 - a1,
          6 * rise - 3 * (v0 + v1) - 0.5 * a0 + 0.5 * a1};
}

double Quintic::at(double tau) const {
    const double s = h_ > 0 ? tau / h_ : 0;
    return c_[0] + s * (c_[1] + s * (c_[2] + s * (c_[3] + s * (c_[4] + s * c_[5]))));
}

double Quintic::slope(double tau) const {
    if (h_ <= 0) return 0;
    const double s = tau / h_;
    return (c_[1] + s * (2 * c_[2] + s * (3 * c_[3] + s * (4 * c_[4] + s * 5 * c_[5])))) / h_;
}

std::optional<double> Quintic::extremum() const {
    const double first = slope(0), last = slope(h_);
    if (!(first * last < 0)) return std::nullopt;
    return root_between([this](double tau) { return slope(tau); }, 0, h_, first, last, kExtremumTolerance * h_);
}

RelayMotion::RelayMotion(const LinearPlant& plant, double direction)
    : n_(plant.realisation().n),
      integrators_(plant.integrators()),
      A_(plant.realisation().A),
      B_(plant.realisation().B),
      C_(plant.realisation().C),
      D_(direction * plant.realisation().D),
      levels_(Index(kLevels)) {
    for (double& c : C_) c *= direction;
    CA_ = row_times(C_, A_);
    CAA_ = row_times(CA_, A_);
    CB_ = dot(C_, B_);
    CAB_ = dot(CA_, B_);
    double fastest = 0;
    for (const auto pole : plant.poles()) {
        const double size = std::abs(pole);
        fastest = std::max(fastest, size);
        const bool decays = pole.real() < -kMaxRelativeRealPart * size;
        const double ends = decays ? (kDecay + 3.0 * n_) / -pole.real() : std::numeric_limits<double>::infinity();
        if (decays) decay_time_ = std::max(decay_time_, ends);
        if (pole.real() > kMaxRelativeRealPart * size) growth_rate_ = std::max(growth_rate_, pole.real());
        modes_.push_back({size, ends});
    }
    if (fastest > 0)
        shortest_ = 1 / (kStepsPerRadian * fastest);
    else if (plant.dead_time() > 0)
        shortest_ = plant.dead_time() / kStepsPerRadian;
}

HeldStep RelayMotion::step(double h) const {
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

const HeldStep& RelayMotion::level(int k) {
    auto& slot = levels_[Index(k)];
    if (!slot) slot = step(std::ldexp(shortest_, k));
    return *slot;
}

void RelayMotion::advance(const HeldStep& step, double v, std::vector<double>& x) const {
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

OutputMotion RelayMotion::output(const std::vector<double>& x, double v) const {
    return {dot(C_, x) + D_ * v, dot(CA_, x) + CB_ * v, dot(CAA_, x) + CAB_ * v};
}

std::vector<double> RelayMotion::rate(const std::vector<double>& x, double v) const {
    std::vector<double> out(Index(n_), 0.0);
    multiply(A_, x, out);
    for (int i = 0; i < n_; ++i) out[Index(i)] += B_[Index(i)] * v;
    return out;
}

bool RelayMotion::bounded() const {
    return integrators_ <= 0 &&
           std::all_of(modes_.begin(), modes_.end(), [](const Mode& mode) { return std::isfinite(mode.ends); });
}

double RelayMotion::spacing(double elapsed, bool& quiet) const {
    double h = std::max(shortest_, elapsed / 4);
    quiet = true;
    for (const Mode& mode : modes_) {
        if (elapsed >= mode.ends) continue;
        quiet = false;
        h = std::min(h, 1 / (kStepsPerRadian * mode.magnitude));
    }
    return h;
}

}  // namespace tunewright
