#include "engine/tuning/robust/sweep/encirclements.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "engine/numerics/pair.h"

namespace tunewright::robust {
namespace {

constexpr double kMaxRelativeRealPart = 1e-9;  // of a pole's real part over its size: a smaller one may be 0

}  // namespace

AxisCrossings::AxisCrossings(std::span<const double> L_re, std::span<const double> L_im) {
    const double *re = L_re.data(), *im = L_im.data();
    double doubtful = 0;  // the largest |L|^2 of an ambiguous interval
    const auto look = [&](std::size_t i) {
        const double re0 = re[i - 1], im0 = im[i - 1], re1 = re[i], im1 = im[i];
        // After more than a quarter of a turn the direction of the curve between them is ambiguous.
        if (re0 * re1 + im0 * im1 < 0) doubtful = std::max({doubtful, re0 * re0 + im0 * im0, re1 * re1 + im1 * im1});
        if ((im0 > 0) == (im1 > 0)) return;
        const double crossed = re0 + (re1 - re0) * im0 / (im0 - im1);
        if (crossed < 0) crossings_.push_back({-1 / crossed, im1 > 0 ? 1 : -1});
    };
    // In nearly all intervals there is no crossing.
    std::size_t i = 1;
    for (; i + 1 < L_re.size(); i += 2) {
        const Pair re0 = load(re + i - 1), im0 = load(im + i - 1), re1 = load(re + i), im1 = load(im + i);
        if (!any((re0 * re1 + im0 * im1 < 0) | ((im0 > 0) ^ (im1 > 0)))) continue;
        look(i);
        look(i + 1);
    }
    if (i < L_re.size()) look(i);
    if (doubtful > 0) doubtful_from_ = 1 / std::sqrt(doubtful);
}

std::optional<int> AxisCrossings::beyond(double k) const {
    if (k >= doubtful_from_) return std::nullopt;
    int count = 0;
    for (const Crossing& crossing : crossings_)
        if (crossing.factor < k) count += crossing.upward;
    return count;
}

std::optional<double> phase_from_rest(const LinearPlant& plant, double omega) {
    if (plant.integrators() < 0) return std::nullopt;
    const auto turned = [omega](std::complex<double> root) {
        return std::atan((omega - root.imag()) / std::abs(root.real()));
    };
    double phase = -omega * plant.dead_time() - 0.5 * std::numbers::pi * plant.integrators();
    // A root in the right half-plane turns P in the other direction.
    for (const auto zero : plant.zeros()) phase += zero.real() > 0 ? -turned(zero) : turned(zero);
    for (const auto pole : plant.poles()) {
        if (std::abs(pole.real()) < kMaxRelativeRealPart * std::abs(pole)) return std::nullopt;
        phase -= pole.real() > 0 ? -turned(pole) : turned(pole);
    }
    return phase;
}

}  // namespace tunewright::robust
