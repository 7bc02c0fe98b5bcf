#include "engine/identification/fit/excited_band.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "engine/numerics/optimise/line_search.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRatio = 1.25;  // ratio of the evaluated frequencies, downwards
constexpr double kNearby = 1.15;
constexpr int kNearbyPoints = 2;  // number of neighbours on either side
constexpr double kFinest = 1.02;  // ratio near the resulting end

struct Change {
    double t, size;
};

std::vector<Change> changes_of(const Excitation& excitation) {
    std::vector<Change> changes;
    double before = excitation.u_rest;
    for (std::size_t i = 0; i < excitation.u.size(); ++i) {
        const double size = excitation.u[i] - before;
        if (size != 0) changes.push_back({excitation.t[i], size});
        before = excitation.u[i];
    }
    return changes;
}

/// |U(j omega)|^2 of the changes alone.
double input_power(const std::vector<Change>& changes, double omega) {
    std::complex<double> sum = 0;
    for (const auto& change : changes) sum += change.size * std::polar(1.0, -omega * change.t);
    return std::norm(sum) / (omega * omega);
}

}  // namespace

std::optional<ExcitedBand> excited_band(const Excitation& excitation, const Plant& plant) {
    const auto linear = LinearPlant::make(plant);
    if (!linear || excitation.t.size() < 2 || !(excitation.sample_time > 0)) return std::nullopt;
    const double duration = excitation.t.back() - excitation.t.front();
    const std::vector<Change> changes = changes_of(excitation);
    if (!(duration > excitation.sample_time) || changes.empty()) return std::nullopt;
    const double noise = excitation.noise_std * excitation.noise_std * excitation.sample_time * duration;
    const auto excited = [&](double omega) {
        for (int k = -kNearbyPoints; k <= kNearbyPoints; ++k) {
            const double near = omega * std::pow(kNearby, double(k) / kNearbyPoints);
            if (std::norm(linear->at({0, near})) * input_power(changes, near) > noise) return true;
        }
        return false;
    };
    ExcitedBand band{2 * kPi / duration, kPi / excitation.sample_time};
    double above = band.omega_high;
    if (excited(above)) return band;
    while (above > band.omega_low && !excited(above / kRatio)) above /= kRatio;
    if (above <= band.omega_low) return std::nullopt;
    const double below = log_bisect({above / kRatio, above}, excited, 1 - 1 / kFinest).inside;
    band.omega_high = std::max(below, band.omega_low);
    return band;
}

}  // namespace tunewright
