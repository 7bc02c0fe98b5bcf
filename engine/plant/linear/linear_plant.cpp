#include "engine/plant/linear/linear_plant.h"

#include <cmath>

#include "engine/numerics/linear_algebra.h"
#include "engine/plant/linear/factor.h"
#include "engine/plant/linear/realisation.h"

namespace tunewright {
namespace {

Realisation as_given(const StateSpace& plant) {
    Realisation realisation;
    realisation.n = static_cast<int>(plant.A.size());
    realisation.A = row_by_row(plant.A);
    realisation.B = plant.B;
    realisation.C = plant.C;
    realisation.D = plant.D;
    return realisation;
}

}  // namespace

double dead_time(const Plant& plant) {
    return std::visit([](const auto& p) { return p.L; }, plant);
}

Expected<LinearPlant> LinearPlant::make(const Plant& plant) {
    auto factors = factor(plant);
    if (!factors) return factors.error();
    LinearPlant result;
    result.gain_ = factors->gain;
    result.integrators_ = factors->integrators;
    result.L_ = tunewright::dead_time(plant);
    result.zeros_ = factors->zeros;
    result.poles_ = factors->poles;
    result.realisation_ =
        std::holds_alternative<StateSpace>(plant) ? as_given(std::get<StateSpace>(plant)) : cascade(*factors);
    return result;
}

std::complex<double> LinearPlant::rational(std::complex<double> s) const {
    std::complex<double> numerator = gain_, denominator = 1;
    for (int i = 0; i < integrators_; ++i) denominator *= s;
    for (int i = 0; i < -integrators_; ++i) numerator *= s;
    for (const auto zero : zeros_) numerator *= s - zero;
    for (const auto pole : poles_) denominator *= s - pole;
    return numerator / denominator;
}

std::complex<double> LinearPlant::at(std::complex<double> s) const {
    return L_ == 0 ? rational(s) : rational(s) * std::exp(-s * L_);
}

int LinearPlant::pole_excess() const {
    return static_cast<int>(poles_.size()) + integrators_ - static_cast<int>(zeros_.size());
}

double LinearPlant::direct_term() const { return pole_excess() == 0 ? gain_ : 0; }

int LinearPlant::unstable_poles() const {
    int count = 0;
    for (const auto pole : poles_) count += pole.real() > 1e-10 * std::abs(pole);
    return count;
}

bool LinearPlant::has_right_half_plane_zero() const {
    for (const auto zero : zeros_)
        if (zero.real() > 1e-10 * std::abs(zero)) return true;
    return false;
}

double LinearPlant::low_frequency_gain() const {
    std::complex<double> value = gain_;
    for (const auto zero : zeros_) value *= -zero;
    for (const auto pole : poles_) value /= -pole;
    return value.real();
}

double LinearPlant::time_scale() const {
    double time = L_;
    for (const auto pole : poles_) time += 1 / std::abs(pole);
    return time;
}

double LinearPlant::lag_sum() const {
    double sum = 0;
    for (const auto pole : poles_)
        if (pole.real() < 0) sum += (-1.0 / pole).real();
    for (const auto zero : zeros_)
        if (zero.real() < 0) sum -= (-1.0 / zero).real();
    return sum;
}

}  // namespace tunewright
