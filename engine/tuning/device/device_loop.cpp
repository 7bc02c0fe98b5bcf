#include "engine/tuning/device/device_loop.h"

#include <algorithm>
#include <limits>

#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/loop/sampled/sampled_loop.h"
#include "engine/loop/stability.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"
#include "engine/simulation/sampled/sampled_response.h"

namespace tunewright::device {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A search compares costs; the figures of an answer are computed again.
constexpr double kTolerance = 1e-5, kSettledTolerance = 1e-6;

bool sampled(const Law& law) { return law.Ts > 0; }

double iae(const StepResponse& response) {
    if (!response.settles) return kInfinity;
    return integral_of_absolute_error(response.nodes, 0, response.error_integral_final);
}

}  // namespace

DevicePlant::DevicePlant(const LinearPlant& plant, double Ts, double computation_delay) : plant_(&plant), Ts_(Ts) {
    if (Ts > 0) held_.emplace(plant, Ts, computation_delay);
}

std::complex<double> DevicePlant::at(double omega) const { return held_ ? held_->at(omega) : plant_->at({0, omega}); }

double DevicePlant::highest_frequency() const { return held_ ? std::numbers::pi / Ts_ : kInfinity; }

std::complex<double> response_of(const Law& law, double omega) {
    return sampled(law) ? pulse_response(law, omega) : controller_response(law.gains, {0, omega});
}

std::vector<double> frequencies_of(const LinearPlant& plant, const Law& law) {
    if (sampled(law)) return SampledLoop(plant, law).grid().omega;
    const auto loop = Loop::make(plant, law.gains);
    return loop ? make_peak_grid(*loop).omega : std::vector<double>{};
}

bool is_stable(const LinearPlant& plant, const Law& law) {
    if (sampled(law)) return SampledLoop(plant, law).count_unstable_poles().stable();
    const auto loop = Loop::make(plant, law.gains);
    return loop && count_unstable_poles(*loop).stable();
}

double PeakValues::excess(const PeakLimits& limits) const {
    const double circles = std::max(Ms / limits.Ms, Mt / limits.Mt);
    return (limits.Mks ? std::max(circles, Mks / *limits.Mks) : circles) - 1;
}

PeakValues peaks_of(const LinearPlant& plant, const Law& law) {
    const auto values = [](const Peaks& peaks) { return PeakValues{peaks.S.value, peaks.T.value, peaks.CS.value}; };
    if (sampled(law)) {
        const SampledLoop loop(plant, law);
        return values(loop.peaks(loop.grid()));
    }
    const auto loop = Loop::make(plant, law.gains);
    if (!loop) return {kInfinity, kInfinity, kInfinity};
    return values(find_peaks(*loop, make_peak_grid(*loop)));
}

double load_iae_of(const LinearPlant& plant, const Law& law) {
    if (sampled(law)) return iae(simulate_sampled(plant, law, {}, {0, 1}, {kTolerance, kSettledTolerance, {}}));
    ResponseOptions options;
    options.tolerance = kTolerance;
    options.settled = kSettledTolerance;
    return iae(simulate_linear(plant, law.gains, {0, 1}, options));
}

}  // namespace tunewright::device
