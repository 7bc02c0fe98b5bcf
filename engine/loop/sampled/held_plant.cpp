#include "engine/loop/sampled/held_plant.h"

#include <cmath>

#include "engine/number_text.h"
#include "engine/numerics/fast_complex.h"
#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/numerics/matrix/resolvent.h"

namespace tunewright {
namespace {

using Index = std::size_t;
using Complex = std::complex<double>;

constexpr double kMultipleTolerance = 1e-9;  // of a sample: a dead time closer than this to a multiple counts as the
                                             // multiple
constexpr int kMaxCounted = 1'000'000'000;

}  // namespace

std::optional<Error> refuse_sampling(const LinearPlant& plant, double sample_time, double computation_delay) {
    const double delay = plant.dead_time() + computation_delay;
    if (delay <= kMaxDelaySamples * sample_time) return std::nullopt;
    return Error{ErrorKind::invalid_argument, "implement/sample_time",
                 "Dead time and computation delay together are " + text(delay) + ", more than " +
                     std::to_string(kMaxDelaySamples) + " sample times of " + text(sample_time) +
                     ". Give a longer sample_time; even a twentieth of the dead time is short."};
}

UnitCircle::UnitCircle(double angle) {
    const double s = std::sin(0.5 * angle), c = std::cos(0.5 * angle), sine = 2 * s * c;
    back = {1 - 2 * s * s, -sine};
    one_minus_back = {2 * s * s, sine};
    minus_one = {-2 * s * s, sine};
}

SampledDelay in_samples(double delay, double sample_time) {
    const double count = delay / sample_time, nearest = std::round(count);
    if (!(count < kMaxCounted)) return {kMaxCounted, 0};
    if (std::abs(count - nearest) <= kMultipleTolerance * std::max(1.0, nearest)) return {static_cast<int>(nearest), 0};
    const double whole = std::floor(count);
    return {static_cast<int>(whole), delay - whole * sample_time};
}

std::vector<double> integrated_exponential(std::span<const double> A, int n, double h) {
    if (n == 1) return {A[0] == 0 ? h : std::expm1(A[0] * h) / A[0]};
    // The upper right block of exp([A, I; 0, 0] h).
    const Index m = static_cast<Index>(n), size = 2 * m;
    std::vector<double> block(size * size, 0.0);
    for (Index i = 0; i < m; ++i) {
        for (Index j = 0; j < m; ++j) block[i * size + j] = h * A[i * m + j];
        block[i * size + m + i] = h;
    }
    const std::vector<double> exponential = matrix_exponential(block, 2 * n);
    std::vector<double> psi(m * m);
    for (Index i = 0; i < m; ++i)
        for (Index j = 0; j < m; ++j) psi[i * m + j] = exponential[i * size + m + j];
    return psi;
}

HeldPlant::HeldPlant(const LinearPlant& plant, double sample_time, double computation_delay)
    : plant_(&plant), Ts_(sample_time) {
    const SampledDelay delay = in_samples(plant.dead_time() + computation_delay, Ts_);
    d_ = delay.whole;
    delta_ = delay.rest;
    const Realisation& r = plant.realisation();
    const auto n = static_cast<Index>(r.n);
    const auto effect_of_hold = [&](double h) {
        std::vector<double> gamma(n);
        if (h > 0) multiply(integrated_exponential(r.A, r.n, h), r.B, gamma);
        return gamma;
    };
    E_ = matrix_product(r.A, integrated_exponential(r.A, r.n, Ts_), r.n);
    Gamma0_ = effect_of_hold(Ts_ - delta_);
    Gamma1_.assign(n, 0.0);
    if (delta_ > 0) {
        std::vector<double> scaled(r.A);
        for (double& a : scaled) a *= Ts_ - delta_;
        multiply(matrix_exponential(scaled, r.n), effect_of_hold(delta_), Gamma1_);
    }
    for (const Complex pole : plant.poles()) poles_.push_back(std::exp(pole * Ts_));
    for (int i = 0; i < plant.integrators(); ++i) poles_.emplace_back(1.0);
}

Complex HeldPlant::at(double omega, const UnitCircle& z) const {
    const Realisation& r = plant_->realisation();
    Complex response = z.back * r.D;
    if (r.n == 1) {
        response += quotient(r.C[0] * (Gamma0_[0] + z.back * Gamma1_[0]), z.minus_one - E_[0]);
    } else if (r.n > 1) {
        const std::vector<Complex> row = resolvent_row(E_, r.C, r.n, z.minus_one);
        for (Index i = 0; i < row.size(); ++i) response += row[i] * (Gamma0_[i] + z.back * Gamma1_[i]);
    }
    return d_ == 0 ? response : response * std::polar(1.0, -omega * Ts_ * d_);
}

}  // namespace tunewright
