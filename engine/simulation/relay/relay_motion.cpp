#include "engine/simulation/relay/relay_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
    : HeldMotion(plant, direction, false), integrators_(plant.integrators()), levels_(Index(kLevels)) {
    double fastest = 0;
    for (const auto pole : plant.poles()) {
        const double size = std::abs(pole);
        fastest = std::max(fastest, size);
        const bool decays = pole.real() < -kMaxRelativeRealPart * size;
        const double ends = decays ? (kDecay + 3.0 * states()) / -pole.real() : std::numeric_limits<double>::infinity();
        if (decays) decay_time_ = std::max(decay_time_, ends);
        if (pole.real() > kMaxRelativeRealPart * size) growth_rate_ = std::max(growth_rate_, pole.real());
        modes_.push_back({size, ends});
    }
    if (fastest > 0)
        shortest_ = 1 / (kStepsPerRadian * fastest);
    else if (plant.dead_time() > 0)
        shortest_ = plant.dead_time() / kStepsPerRadian;
}

const HeldStep& RelayMotion::level(int k) {
    auto& slot = levels_[Index(k)];
    if (!slot) slot = step(std::ldexp(shortest_, k));
    return *slot;
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
