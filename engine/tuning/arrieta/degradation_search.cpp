#include "engine/tuning/arrieta/degradation_search.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/number_text.h"
#include "engine/tuning/arrieta/arrieta_rule.h"
#include "engine/tuning/arrieta/tradeoff.h"

namespace tunewright {
namespace {

constexpr int kPoints = 25;  // of the scan: every 0.025
constexpr double kAccuracy = 1e-9;
constexpr int kMaxHalvings = 60;

struct Sample {
    double Ms = 0, Deg = 0;
};

class Branch {
public:
    Branch(const Fopdt& model, const ReferenceControllers& references)
        : model_(model), scale_(*LinearPlant::make(model), references) {}

    std::optional<double> degradation(double Ms) const {
        const Pid pid = arrieta_pid(arrieta_equation_9(Ms, ArrietaC3::refitted), model_);
        return pid.Td >= 0 ? scale_.degradation(to_parallel(pid)) : std::nullopt;
    }

private:
    Fopdt model_;
    TradeoffScale scale_;
};

// Regula falsi with the Illinois weighting between two samples on either side of `target`.
double root(const Branch& branch, Sample a, Sample b, double target) {
    double fa = a.Deg - target, fb = b.Deg - target;
    for (int i = 0; i < kMaxHalvings && b.Ms - a.Ms > kAccuracy; ++i) {
        const double Ms = (a.Ms * fb - b.Ms * fa) / (fb - fa);
        const auto Deg = branch.degradation(Ms);
        if (!Deg) return Ms;
        const double f = *Deg - target;
        if (std::abs(f) < kAccuracy) return Ms;
        if ((f > 0) == (fb > 0)) {
            b = {Ms, *Deg};
            fb = f;
            fa /= 2;
        } else {
            a = {Ms, *Deg};
            fa = f;
            fb /= 2;
        }
    }
    return (a.Ms + b.Ms) / 2;
}

Error out_of_reach(const std::vector<Sample>& samples, double degradation) {
    const auto [low, high] = std::ranges::minmax_element(samples, {}, &Sample::Deg);
    return {ErrorKind::unsupported, "degradation",
            "degradation is " + text(degradation) + "; with Ms from 1.4 to 2 this rule has " + text(low->Deg) +
                " (Ms = " + text(low->Ms) + ") to " + text(high->Deg) + " (Ms = " + text(high->Ms) +
                ") on this model. Ask for one in that range, or 0 for the tuning without a limit on Ms."};
}

}  // namespace

Expected<double> Ms_of_degradation(const Fopdt& model, double degradation, const std::stop_token& stop) {
    const auto references = reference_controllers(model);
    if (!references) return references.error();
    if (!references->free)
        return Error{ErrorKind::unsupported, "plant",
                     "L/T is " + text(model.L / model.T) +
                         ", where the tuning without a limit on Ms has Td < 0: there is nothing to measure a "
                         "degradation by. The rule holds for L/T from 0.1 to 2; use simc, amigo or robust."};
    const Branch branch(model, *references);
    std::vector<Sample> samples;
    for (int i = 0; i < kPoints; ++i) {
        if (stop.stop_requested())
            return Error{ErrorKind::cancelled, "", "The job was cancelled before a design was found."};
        const double Ms = std::lerp(kArrietaLowestMs, kArrietaHighestMs, i / (kPoints - 1.0));
        const auto Deg = branch.degradation(Ms);
        if (!Deg) continue;
        if (*Deg == degradation) return Ms;
        if (!samples.empty() && (samples.back().Deg > degradation) != (*Deg > degradation))
            return root(branch, samples.back(), {Ms, *Deg}, degradation);
        samples.push_back({Ms, *Deg});
    }
    if (samples.empty())
        return Error{ErrorKind::unsupported, "plant",
                     "The rule does not stabilise this model for any Ms from 1.4 to 2. Use amigo or robust."};
    return out_of_reach(samples, degradation);
}

}  // namespace tunewright
