#include "engine/evaluation/longest_sample_time.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "engine/loop/sampled/sampled_loop.h"
#include "engine/numerics/extremum.h"
#include "engine/numerics/fast_complex.h"
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
constexpr double kTolerance = 5e-5;    // of a sample time that is a guess
constexpr double kExact = 1e-6;        // of one that is none, and of the Ms there
constexpr double kNearby = 1.03;       // from one sample time to the next, where a guess was inexact
constexpr int kMostNearby = 10;
constexpr double kWholeLoop = 1e-3;  // relative: how far the whole loop's Ms may be from that of the guess

/// |S| at the top of its hill near where it was last, as the sample time changes. Another hill that takes over is not
/// seen.
class TrackedPeak {
public:
    TrackedPeak(const LinearPlant& plant, const ParallelPid& gains, double omega)
        : plant_(plant), gains_(gains), omega_(omega) {}

    /// By a parabola through three points in ln omega: quick, and mostly good to 1e-3.
    double roughly(double Ts) { return walk(sampled(Ts)); }
    /// To rounding.
    double exactly(double Ts) {
        const SampledLoop loop = sampled(Ts);
        walk(loop);
        const double left = omega_ / kStep, right = std::min(omega_ * kStep, loop.highest_frequency());
        const auto S = [&](double omega) { return magnitude(loop.at(omega).S); };
        const double ends = std::max(S(left), S(right)), here = S(omega_);
        return here < ends ? ends : log_maximum(S, left, {omega_, here}, right).value;
    }

private:
    static constexpr double kStep = 1.12;
    static constexpr int kMostSteps = 30;

    SampledLoop sampled(double Ts) const { return {plant_, {.gains = gains_, .Ts = Ts}}; }

    double walk(const SampledLoop& loop) {
        const double highest = loop.highest_frequency();
        const auto S = [&](double omega) { return magnitude(loop.at(std::min(omega, highest)).S); };
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
    SampledLoop loop(double Ts) const { return {plant_, {.gains = gains_, .Ts = Ts}}; }
    bool bears(double Ts) const { return loop(Ts).keeps(limit_); }
    double shortest() const { return std::max(kShortest / omega_Ms_, plant_.dead_time() / kMostInDelay); }
    double longest() const { return kLongest / omega_Ms_; }

    /// Of |S| over the limit.
    double excess(double S) const { return std::log(S / limit_); }

    /// Where the continuous loop's peak comes to the limit.
    std::optional<double> guess(TrackedPeak& peak) const {
        const auto roughly = [&](double Ts) { return excess(peak.roughly(Ts)); };
        double high = kFirstSample / omega_Ms_, f_high = roughly(high);
        while (f_high <= 0 && high < longest()) f_high = roughly(high *= 2);
        if (f_high <= 0) return std::nullopt;
        const double Ts = root_between(roughly, 0, high, at_0_, f_high, kTolerance * high);
        const double left = excess(peak.exactly(Ts));
        return std::abs(left) <= kWholeLoop ? Ts : exactly_reached(peak, Ts, left);
    }

    /// The same near Ts, where the peak exceeds the limit by `f`.
    std::optional<double> exactly_reached(TrackedPeak& peak, double Ts, double f) const {
        const auto exactly = [&](double h) { return excess(peak.exactly(h)); };
        for (int i = 0; i < kMostNearby; ++i) {
            const double next = f > 0 ? Ts / kNearby : Ts * kNearby, f_next = exactly(next);
            if ((f_next > 0) != (f > 0)) return root_between(exactly, Ts, next, f, f_next, kExact * Ts);
            Ts = next;
            f = f_next;
        }
        return std::nullopt;
    }

    /// Where nothing resonates the continuous loop's own peak decides, nearly: a guess from it alone, which the whole
    /// loop confirms.
    std::optional<double> by_peak() {
        TrackedPeak peak(plant_, gains_, omega_Ms_);
        const auto Ts = guess(peak);
        if (!Ts || *Ts < shortest()) return std::nullopt;
        low_ = std::max(kShorter * *Ts, shortest());
        bool borne = bears(*low_);
        // The guess's own peak is at the limit: the whole loop is no better.
        if (borne && loop(*Ts).keeps(limit_ * (1 + kWholeLoop))) return Ts;
        // Another peak of the loop has become the higher one: what is looked for lies not far below.
        while (*low_ > shortest()) {
            const double lower = std::max(kShorter * *low_, shortest());
            const bool lower_borne = bears(lower);
            if (borne && lower_borne) break;
            low_ = lower;
            borne = lower_borne;
        }
        return std::nullopt;
    }

    /// The first sample time, from short ones on, that the whole loop does not bear.
    std::optional<double> by_steps() const {
        double low = low_.value_or(shortest()), high = low * kNext;
        if (!bears(low)) return std::nullopt;
        for (; bears(high); high *= kNext) {
            if (high > longest()) return std::nullopt;
            low = high;
        }
        return between(low, high);
    }

    /// Where the whole loop's Ms comes to the limit: the quick looks have seen it below at `low`, above at `high`.
    double between(double low, double high) const {
        const auto whole = [this](double Ts) { return excess(loop(Ts).sensitivity_peak().value); };
        double f_low = whole(low);
        // They look less closely than the whole loop's peak is sought: it has the last word.
        for (; f_low > kExact && low > shortest(); f_low = whole(low)) {
            high = low;
            low = std::max(low / kNext, shortest());
        }
        const Peak above = loop(high).sensitivity_peak();
        if (above.omega > 0) {
            TrackedPeak peak(plant_, gains_, above.omega);
            const auto exactly = [&](double Ts) { return excess(peak.exactly(Ts)); };
            const double at_high = exactly(high), at_low = exactly(low);
            if (at_low < 0 && at_high > 0) {
                const double Ts = root_between(exactly, low, high, at_low, at_high, kExact * high);
                if (std::abs(whole(Ts)) <= kExact) return Ts;
            }
        }
        // They agree with Ms but for its last digits.
        const double f_high = std::clamp(excess(above.value), 0.0, 1.0);
        return root_between(whole, low, high, std::min(f_low, 0.0), f_high, kExact * high);
    }

    const LinearPlant& plant_;
    const ParallelPid& gains_;
    double limit_, at_0_, omega_Ms_;
    std::optional<double> low_;  // where the steps start
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
