#include "engine/evaluation/longest_sample_time.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "engine/loop/sampled/sampled_loop.h"
#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

constexpr double kFirstSample = 0.1;   // of 1/omega_Ms: where the search starts
constexpr double kShortest = 1e-3;     // of 1/omega_Ms
constexpr double kLongest = 1e3;       // of 1/omega_Ms: where it ends
constexpr double kMostInDelay = 3e4;   // sample times in the dead time: a loop is looked at once for each
constexpr double kShorter = 0.6;       // of a sample time: a shorter one that the whole loop must bear too
constexpr double kLightDamping = 0.5;  // of a pole
constexpr double kNext = 1.1;          // from one sample time to the next, where they are looked at one by one
constexpr double kTolerance = 5e-5;    // of a sample time
constexpr double kWholeLoop = 1e-3;    // relative: how far the whole loop's Ms may be from that of the guess

/// |S| at the top of its hill near where it was last, as the sample time changes: by a parabola through three points in
/// ln omega, good to 1e-4 and quick. Another hill that takes over is not seen.
class TrackedPeak {
public:
    TrackedPeak(const LinearPlant& plant, const ParallelPid& gains, double omega)
        : plant_(plant), gains_(gains), omega_(omega) {}

    double at(double Ts) {
        const SampledLoop loop(plant_, {.gains = gains_, .Ts = Ts});
        const double highest = loop.highest_frequency();
        const auto S = [&](double omega) { return std::abs(loop.at(std::min(omega, highest)).S); };
        omega_ = std::min(omega_, highest / kStep);
        double below = S(omega_ / kStep), here = S(omega_), above = S(omega_ * kStep);
        for (int i = 0; i < kMostSteps && (below > here || above > here); ++i) {
            const bool up = above > below;
            if (up && omega_ * kStep * kStep > highest) break;
            omega_ *= up ? kStep : 1 / kStep;
            (up ? below : above) = here;
            here = up ? above : below;
            (up ? above : below) = S(up ? omega_ * kStep : omega_ / kStep);
        }
        const double bend = below - 2 * here + above, slope = 0.5 * (above - below);
        return bend < 0 ? here - 0.5 * slope * slope / bend : std::max({below, here, above});
    }

private:
    static constexpr double kStep = 1.12;
    static constexpr int kMostSteps = 30;
    const LinearPlant& plant_;
    ParallelPid gains_;
    double omega_;
};

/// A lightly damped mode is sampled well and badly in turns as the sample time grows.
bool resonates(const LinearPlant& plant) {
    return std::ranges::any_of(plant.poles(), [](std::complex<double> pole) {
        return std::abs(pole.real()) < kLightDamping * std::abs(pole);
    });
}

class Search {
public:
    Search(const LinearPlant& plant, const ParallelPid& gains, double Ms, double omega_Ms, double factor)
        : plant_(plant), gains_(gains), limit_(factor * Ms), at_0_(-std::log(factor)), omega_Ms_(omega_Ms) {}

    std::optional<double> result() {
        if (!resonates(plant_))
            if (const auto Ts = by_peak()) return Ts;
        return by_steps();
    }

private:
    /// Of the whole loop; > 0: Ts is too long.
    double excess_at(double Ts) const {
        return std::log(SampledLoop(plant_, {.gains = gains_, .Ts = Ts}).Ms() / limit_);
    }
    double shortest() const { return std::max(kShortest / omega_Ms_, plant_.dead_time() / kMostInDelay); }
    double longest() const { return kLongest / omega_Ms_; }

    /// Where the continuous loop's peak comes to the limit.
    std::optional<double> guess() const {
        TrackedPeak peak(plant_, gains_, omega_Ms_);
        const auto near_peak = [&](double Ts) { return std::log(peak.at(Ts) / limit_); };
        double high = kFirstSample / omega_Ms_, f_high = near_peak(high);
        while (f_high <= 0 && high < longest()) f_high = near_peak(high *= 2);
        if (f_high <= 0) return std::nullopt;
        return root_between(near_peak, 0, high, at_0_, f_high, kTolerance * high);
    }

    /// Where nothing resonates the continuous loop's own peak decides, nearly: a guess from it alone, which the whole
    /// loop confirms.
    std::optional<double> by_peak() {
        const auto Ts = guess();
        if (!Ts || *Ts < shortest()) return std::nullopt;
        low_ = std::max(kShorter * *Ts, shortest());
        f_low_ = excess_at(*low_);
        if (f_low_ <= 0 && std::abs(excess_at(*Ts)) <= kWholeLoop) return Ts;
        // Another peak of the loop has become the higher one: what is looked for lies not far below.
        while (*low_ > shortest()) {
            const double lower = std::max(kShorter * *low_, shortest()), f_lower = excess_at(lower);
            if (f_low_ <= 0 && f_lower <= 0) break;
            low_ = lower;
            f_low_ = f_lower;
        }
        return std::nullopt;
    }

    /// The first sample time, from short ones on, that the whole loop does not bear.
    std::optional<double> by_steps() const {
        double low = low_.value_or(shortest()), f_low = low_ ? f_low_ : excess_at(low);
        if (f_low > 0) return std::nullopt;
        double high = low * kNext, f_high = 0;
        while ((f_high = excess_at(high)) <= 0) {
            if (high > longest()) return std::nullopt;
            low = high;
            f_low = f_high;
            high *= kNext;
        }
        return root_between([this](double Ts) { return excess_at(Ts); }, low, high, f_low, std::min(f_high, 1.0),
                            kTolerance * high);
    }

    const LinearPlant& plant_;
    const ParallelPid& gains_;
    double limit_, at_0_, omega_Ms_;
    std::optional<double> low_;  // where the steps start, and the excess there
    double f_low_ = 0;
};

}  // namespace

std::optional<double> longest_sample_time(const LinearPlant& plant, const ParallelPid& gains, double Ms,
                                          double omega_Ms, double factor) {
    return Search(plant, gains, Ms, omega_Ms, factor).result();
}

std::optional<Figure> longest_sample_time_of(const Subject& subject, const Evaluation& evaluation) {
    const LinearPlant* plant = subject.linear();
    const Robustness& r = evaluation.robustness;
    if (plant == nullptr || std::holds_alternative<Npid>(evaluation.controller)) return std::nullopt;
    if (!r.stable || !r.Ms || !r.omega_Ms || !(*r.omega_Ms > 0)) return std::nullopt;
    return Figure(longest_sample_time(*plant, gains(evaluation.controller), *r.Ms, *r.omega_Ms, kMsAsSampled),
                  "No sample time was found that keeps Ms within 5 % and a longer one that does not.");
}

}  // namespace tunewright
