#include "engine/tuning/device/device_loop.h"

#include <limits>

#include "engine/loop/sampled/sampled_loop.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"
#include "engine/simulation/sampled/sampled_response.h"

namespace tunewright::device {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A search compares costs; the figures of an answer are computed again.
constexpr double kTolerance = 1e-5, kSettledTolerance = 1e-6;

bool sampled(const Law& law) { return law.Ts > 0; }

template <class Use>
auto with_loop(const LinearPlant& plant, const Law& law, Use use) {
    return sampled(law) ? use(Expected<SampledLoop>(SampledLoop(plant, law))) : use(Loop::make(plant, law.gains));
}

double iae(const StepResponse& response) {
    if (!response.settles) return kInfinity;
    return integral_of_absolute_error(response.nodes, 0, response.error_integral_final);
}

}  // namespace

std::complex<double> response_of(const Law& law, double omega) {
    return sampled(law) ? pulse_response(law, omega) : controller_response(law.gains, {0, omega});
}

std::vector<double> frequencies_of(const LinearPlant& plant, const Law& law) {
    return with_loop(plant, law,
                     [](const auto& loop) { return loop ? make_peak_grid(*loop).omega : std::vector<double>{}; });
}

bool is_stable(const LinearPlant& plant, const Law& law) {
    return with_loop(plant, law, [](const auto& loop) { return tunewright::is_stable(loop); });
}

std::optional<Peaks> stable_peaks(const LinearPlant& plant, const Law& law) {
    return with_loop(plant, law, [](const auto& loop) {
        return tunewright::is_stable(loop) ? std::optional(find_peaks(*loop, make_peak_grid(*loop))) : std::nullopt;
    });
}

double excess_on(const LinearPlant& plant, const Law& law, const PeakLimits& limits) {
    const auto peaks = stable_peaks(plant, law);
    return peaks ? excess_of(*peaks, limits) : kInfinity;
}

double load_iae_of(const LinearPlant& plant, const Law& law) {
    if (sampled(law)) return iae(simulate_sampled(plant, law, {}, {0, 1}, {kTolerance, kSettledTolerance, {}}));
    ResponseOptions options;
    options.tolerance = kTolerance;
    options.settled = kSettledTolerance;
    return iae(simulate_linear(plant, law.gains, {0, 1}, options));
}

}  // namespace tunewright::device
