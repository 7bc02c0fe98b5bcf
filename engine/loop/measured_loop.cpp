#include "engine/loop/measured_loop.h"

#include <cmath>
#include <numbers>

#include "engine/number_text.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr double kPi = std::numbers::pi;
constexpr double kMaxStepOfS = 0.06;        // change of S between neighbours
constexpr double kMaxFrequencyRatio = 1.2;  // ratio of neighbouring frequencies
constexpr double kMaxAxisDistance = 1e-9;   // |1 + L|: closer to 0 counts as on the axis

}  // namespace

Expected<MeasuredLoop> MeasuredLoop::make(const MeasuredPlant& plant, const ParallelPid& gains) {
    if (auto error = check_controller(gains)) return *error;
    const MeasuredLoop loop(plant, gains);
    const double end = std::abs(loop.at(plant.high()).L);
    if (end <= kMaxModulusAtEnd) return loop;
    return Error{ErrorKind::unsupported, "controller",
                 "The measured band ends at omega " + text(plant.high()) + ", where |L| is still " + text(end) +
                     "; it must reach frequencies at which |L| is below " + text(kMaxModulusAtEnd) +
                     ". Measure higher frequencies, or lower the gain."};
}

LoopPoint MeasuredLoop::at(double omega) const {
    const Complex C = controller_response(gains_, {0, omega}), L = plant_->at(omega) * C;
    return {L, 1.0 / (1.0 + L), L / (1.0 + L), C / (1.0 + L)};
}

LoopGrid make_loop_grid(const MeasuredLoop& loop) {
    const auto& measured = loop.plant().omega();
    std::vector<double> base{measured.front()};
    for (std::size_t i = 1; i < measured.size(); ++i) {
        const double log_ratio = std::log(measured[i]) - std::log(measured[i - 1]);
        int parts = 1;
        while (log_ratio / parts > std::log(kMaxFrequencyRatio)) parts *= 2;
        for (int k = 1; k < parts; ++k) base.push_back(measured[i - 1] * std::exp(log_ratio * k / parts));
        base.push_back(measured[i]);
    }
    return refined_grid([&](double omega) { return loop.at(omega); }, base, loop.plant().high(), kMaxStepOfS);
}

StabilityCount count_unstable_poles(const MeasuredLoop& loop) {
    // From omega = 0+ to infinity 1 + L turns by pi (N/2 + p - Z): N integrators, p unstable poles of L, Z unstable
    // poles of the loop.
    const MeasuredPlant& plant = loop.plant();
    const ParallelPid& gains = loop.gains();
    const int N = plant.integrators() + (gains.Ki != 0 ? 1 : 0);
    const LoopGrid grid = make_loop_grid(loop);
    Complex before = 1.0 + grid.point.front().L;
    // 1 + L tends to low_gain/(j omega)^N for omega -> 0.
    const double low_gain = plant.static_sign() * (gains.Ki != 0 ? gains.Ki : gains.Kp);
    const double start = N > 0 ? low_gain : before.real();
    double angle = std::arg(before / ((start < 0 ? -1.0 : 1.0) * std::polar(1.0, -0.5 * kPi * N)));
    for (const LoopPoint& point : grid.point) {
        const Complex here = 1.0 + point.L;
        if (std::abs(here) < kMaxAxisDistance) return {.unstable_poles = 0, .on_the_boundary = true};
        angle += std::arg(here / before);
        before = here;
    }
    angle -= std::arg(before);
    return {.unstable_poles = static_cast<int>(std::lround(0.5 * N + plant.unstable_poles() - angle / kPi))};
}

}  // namespace tunewright
