#include "engine/loop/measured_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/number_text.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr double kPi = std::numbers::pi;
constexpr double kMaxStepOfS = 0.06;        // change of S between neighbours
constexpr double kMaxFrequencyRatio = 1.2;  // ratio of neighbouring frequencies
constexpr std::size_t kMaxPoints = 20000;
constexpr double kClosestNeighbours = 1e-6;  // relative distance below which no point is added
constexpr double kMaxAxisDistance = 1e-9;    // |1 + L|: closer to 0 counts as on the axis

}  // namespace

MeasuredLoop::MeasuredLoop(const MeasuredPlant& plant, const ParallelPid& gains) : plant_(&plant), gains_(gains) {
    const auto& measured = plant.omega();
    omega_.push_back(measured.front());
    std::vector<double> pending;
    for (std::size_t i = 1; i < measured.size(); ++i) {
        pending.assign(1, measured[i]);
        while (!pending.empty()) {
            const double left = omega_.back(), right = pending.back();
            const Complex a = at(left).S, b = at(right).S;
            const bool far = right > left * kMaxFrequencyRatio ||
                             std::abs(a - b) > kMaxStepOfS * std::max(1.0, std::min(std::abs(a), std::abs(b)));
            if (far && right > left * (1 + kClosestNeighbours) && omega_.size() + pending.size() < kMaxPoints) {
                pending.push_back(std::sqrt(left * right));
                continue;
            }
            omega_.push_back(right);
            pending.pop_back();
        }
    }
}

Expected<MeasuredLoop> MeasuredLoop::make(const MeasuredPlant& plant, const ParallelPid& gains) {
    if (auto error = check_controller(gains)) return *error;
    return MeasuredLoop(plant, gains);
}

LoopPoint MeasuredLoop::at(double omega) const {
    const Complex C = controller_response(gains_, {0, omega}), L = plant_->at(omega) * C;
    return {L, 1.0 / (1.0 + L), L / (1.0 + L), C / (1.0 + L)};
}

std::optional<std::string> MeasuredLoop::band_too_short() const {
    const double end = std::abs(at(plant_->high()).L);
    if (end <= kLargestEnd) return std::nullopt;
    return "The measured band ends at omega " + text(plant_->high()) + ", where |L| is still " + text(end) +
           "; it must reach frequencies at which |L| is below " + text(kLargestEnd) +
           ". Measure higher frequencies, or lower the gain.";
}

StabilityCount MeasuredLoop::count_unstable_poles() const {
    // From omega = 0+ to infinity 1 + L turns by pi (N/2 + p - Z): N integrators, p unstable poles of L, Z unstable
    // poles of the loop.
    const int N = plant_->integrators() + (gains_.Ki != 0 ? 1 : 0);
    const double low_gain = plant_->static_sign() * (gains_.Ki != 0 ? gains_.Ki : gains_.Kp);
    Complex before = 1.0 + at(omega_.front()).L;
    double angle = 0;
    if (N > 0) {
        // 1 + L tends to low_gain/(j omega)^N for omega -> 0.
        const Complex direction = (low_gain > 0 ? 1.0 : -1.0) * std::polar(1.0, -0.5 * kPi * N);
        angle = std::arg(before / direction);
    } else {
        angle = std::arg(before / (before.real() < 0 ? -1.0 : 1.0));
    }
    for (const double omega : omega_) {
        const Complex here = 1.0 + at(omega).L;
        if (std::abs(here) < kMaxAxisDistance) return {.unstable_poles = 0, .on_the_boundary = true};
        angle += std::arg(here / before);
        before = here;
    }
    angle -= std::arg(before);
    return {.unstable_poles = static_cast<int>(std::lround(0.5 * N + plant_->unstable_poles() - angle / kPi))};
}

LoopGrid MeasuredLoop::grid() const {
    LoopGrid grid{omega_, {}, plant_->high()};
    for (const double omega : omega_) grid.point.push_back(at(omega));
    return grid;
}

Peaks MeasuredLoop::peaks() const {
    return find_interior_peaks([this](double omega) { return at(omega); }, grid());
}

Margins MeasuredLoop::margins() const {
    return find_interior_margins([this](double omega) { return at(omega).L; }, grid());
}

}  // namespace tunewright
