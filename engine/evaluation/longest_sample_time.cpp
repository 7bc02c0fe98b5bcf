#include "engine/evaluation/longest_sample_time.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "engine/loop/loop.h"
#include "engine/loop/peaks.h"
#include "engine/loop/sampled/sampled_loop.h"
#include "engine/number_text.h"
#include "engine/numerics/fast_complex.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

constexpr const char* kNone =
    "The search did not find the limit: a sample time that keeps Ms within 5 %, and a longer one "
    "that does not.";

constexpr double kFirstSample = 0.1;             // multiple of 1/omega_Ms: the start of the search
constexpr double kShortest = 1e-3;               // of 1/omega_Ms
constexpr double kLongest = 1e3;                 // multiple of 1/omega_Ms: the end of the search
constexpr double kMaxSamplesInDelay = 3e4;       // sample times in the dead time: the loop is evaluated once for each
constexpr double kShorterFactor = 0.6;           // factor to a shorter sample time that the loop must tolerate too
constexpr double kLightDamping = 0.5;            // damping of a pole
constexpr double kStepFactor = 1.04;             // ratio of successive sample times that are tried one by one
constexpr double kStepFactorNearLimit = 1.01;    // the same near the limit of Ms,
constexpr double kMinMsShareNearLimit = 0.98;    // of it
constexpr double kStepFactorShort = 1.2;         // the same while sampling hardly matters
constexpr double kMaxContinuousSwing = 0.2;      // rad of the fastest oscillation in a sample, and
constexpr double kMaxContinuousTimeRatio = 0.1;  // multiple of 1/omega_Ms: below both, sampling hardly matters
constexpr double kMaxSwingStep = 0.15;           // rad of the fastest oscillation between successive sample times
constexpr double kMaxUnseenExcess = 5e-3;        // relative change of |S| by a mode whose oscillation is not followed
constexpr int kMaxLoopEvaluations = 5000;        // evaluations of the whole loop, one after the other: some seconds
constexpr double kMaxRoughLogError = 4e-3;       // error of ln Ms in the quick evaluation
constexpr double kSmoothingLag = 15;             // sample times: with a longer lag Ms has no edges
constexpr double kMaxTurn = 1.5;              // rad of omega_Ms in a sample: beyond it a peak nearby is not the loop's
constexpr double kScanFrom = 0.1;             // fraction of the guess: the peak is followed from there
constexpr double kScanNext = 1.03;            // ratio of successive sample times there
constexpr int kMaxWholeLoopEvaluations = 16;  // evaluations of the whole loop at dead times of whole samples
constexpr double kTimeTolerance = 1e-9;       // relative: sample times closer than this are equal
constexpr double kTolerance = 5e-5;           // relative tolerance of a guessed sample time
constexpr double kExactTolerance = 1e-6;      // relative tolerance of a confirmed one, and of its Ms
constexpr double kNearbyFactor = 1.03;        // ratio of successive sample times near an inexact guess
constexpr int kMaxNearby = 10;
constexpr int kMaxPeaks = 3;                      // peaks of the loop that are followed, one after the other
constexpr double kOtherPeak = 0.3;                // in ln omega: a peak further off is another one
constexpr double kMaxWholeLoopDifference = 1e-3;  // relative: Ms of the whole loop against the guess

/// The peak of |S| nearest to its last frequency, followed as the sample time changes. It does not notice another peak
/// that becomes higher.
class TrackedPeak {
public:
    TrackedPeak(const LinearPlant& plant, const ParallelPid& gains, double omega)
        : plant_(plant), gains_(gains), omega_(omega) {}

    /// By a parabola through three points in ln omega: quick, error mostly below 1e-3.
    double roughly(double Ts) { return walk(sampled(Ts)); }
    /// Accurate to rounding.
    double exactly(double Ts) {
        const SampledLoop loop = sampled(Ts);
        walk(loop);
        const double left = omega_ / kFrequencyStep,
                     right = std::min(omega_ * kFrequencyStep, loop.highest_frequency());
        const auto S = [&](double omega) { return magnitude(loop.at(omega).S); };
        const double ends = std::max(S(left), S(right)), here = S(omega_);
        return here < ends ? ends : log_maximum(S, left, {omega_, here}, right).value;
    }

private:
    static constexpr double kFrequencyStep = 1.12;
    static constexpr int kMaxSteps = 30;

    SampledLoop sampled(double Ts) const { return {plant_, {.gains = gains_, .Ts = Ts}}; }

    double walk(const SampledLoop& loop) {
        const double highest = loop.highest_frequency();
        const auto S = [&](double omega) { return magnitude(loop.at(std::min(omega, highest)).S); };
        omega_ = std::min(omega_, highest / kFrequencyStep);
        double below = S(omega_ / kFrequencyStep), here = S(omega_), above = S(omega_ * kFrequencyStep);
        for (int i = 0; i < kMaxSteps && (below > here || above > here); ++i) {
            const bool up = above > below;
            if (up && omega_ * kFrequencyStep * kFrequencyStep > highest) break;
            omega_ *= up ? kFrequencyStep : 1 / kFrequencyStep;
            (up ? below : above) = here;
            here = up ? above : below;
            (up ? above : below) = S(up ? omega_ * kFrequencyStep : omega_ / kFrequencyStep);
        }
        const double bend = below - 2 * here + above, slope = 0.5 * (above - below);
        return bend < 0 ? here - 0.5 * slope * slope / bend : std::max({below, here, above});
    }

    const LinearPlant& plant_;
    ParallelPid gains_;
    double omega_;
};

/// A lightly damped mode of the plant: its effect on the sampled loop rises and falls as the sample time grows.
struct Mode {
    double swing = 0;  ///< imaginary part of its pole, rad/time
    double decay = 0;  ///< minus the real part, 1/time
    double share = 0;  ///< |residue of P(s)/s at the pole| without the dead time: its amplitude in the step response

    /// Upper bound of the pair's contribution to the pulse response on the unit circle: each pole adds share (z0 -
    /// 1)/(z - z0), z0 = e^((-decay + j swing) Ts).
    double gain(double Ts) const {
        return decay > 0 ? 4 * share / -std::expm1(-decay * Ts) : std::numeric_limits<double>::infinity();
    }
};

std::vector<Mode> light_modes(const LinearPlant& plant) {
    std::vector<Mode> modes;
    for (const std::complex<double> pole : plant.poles()) {
        if (!(pole.imag() > 0) || std::abs(pole.real()) >= kLightDamping * std::abs(pole)) continue;
        std::complex<double> residue = plant.gain() / std::pow(pole, plant.integrators() + 1);
        for (const std::complex<double> zero : plant.zeros()) residue *= pole - zero;
        bool itself = true;
        for (const std::complex<double> other : plant.poles()) {
            if (itself && other == pole)
                itself = false;
            else
                residue /= pole - other;
        }
        const double share = std::abs(residue);  // infinite for a double pole, which is therefore followed
        modes.push_back({pole.imag(), -pole.real(), std::isnan(share) ? HUGE_VAL : share});
    }
    return modes;
}

/// Peak of |C S| of the continuous loop.
double noise_gain_peak(const LinearPlant& plant, const ParallelPid& gains) {
    const auto loop = Loop::make(plant, gains);
    return loop ? find_peaks(*loop, make_peak_grid(*loop)).CS.value : HUGE_VAL;
}

/// Ms as a function of Ts has edges without a lag much longer than the sample time. Then an input that arrives within a
/// sample counts nearly in full or not at all at its end: the effective delay falls from L + Ts to L when the dead time
/// becomes one whole sample shorter.
bool has_edges(const LinearPlant& plant, double Ts) {
    if (plant.dead_time() == 0 || plant.integrators() > 0) return false;
    return std::ranges::none_of(plant.poles(),
                                [=](std::complex<double> pole) { return std::abs(pole) * kSmoothingLag * Ts < 1; });
}

/// The longest sample time in (Ts, next] that divides the dead time into whole samples, where Ms has its edges and is
/// largest; else `next`.
double at_edge(const LinearPlant& plant, double Ts, double next) {
    const double L = plant.dead_time();
    if (L == 0) return next;
    const double edge = L / std::ceil(L / next * (1 - kTimeTolerance));
    return edge > Ts * (1 + kTimeTolerance) && edge <= next ? edge : next;
}

class Search {
public:
    Search(const LinearPlant& plant, const ParallelPid& gains, double Ms, double omega_Ms, double factor,
           const std::stop_token& stop)
        : plant_(plant),
          gains_(gains),
          limit_(factor * Ms),
          at_0_(-std::log(factor)),
          omega_Ms_(omega_Ms),
          stop_(stop),
          modes_(light_modes(plant)),
          Mks_(modes_.empty() ? 0 : noise_gain_peak(plant, gains)) {}

    Figure result() {
        if (modes_.empty())
            if (const auto Ts = by_peak()) return Ts;
        return by_steps();
    }

private:
    SampledLoop loop(double Ts) const { return {plant_, {.gains = gains_, .Ts = Ts}}; }
    bool bears(double Ts) const { return loop(Ts).keeps(limit_); }
    double shortest() const { return std::max(kShortest / omega_Ms_, plant_.dead_time() / kMaxSamplesInDelay); }
    double longest() const { return kLongest / omega_Ms_; }

    /// ln of |S| over the limit.
    double excess(double S) const { return std::log(S / limit_); }

    /// The sample time at which the continuous loop's peak reaches the limit.
    std::optional<double> guess(TrackedPeak& peak) const {
        const auto roughly = [&](double Ts) { return excess(peak.roughly(Ts)); };
        double high = kFirstSample / omega_Ms_, f_high = roughly(high);
        while (f_high <= 0 && high < longest()) f_high = roughly(high *= 2);
        if (f_high <= 0) return std::nullopt;
        const double Ts = root_between(roughly, 0, high, at_0_, f_high, kTolerance * high);
        const double left = excess(peak.exactly(Ts));
        return std::abs(left) <= kMaxWholeLoopDifference ? Ts : exactly_reached(peak, Ts, left);
    }

    /// The same near Ts, where the peak exceeds the limit by `f` (in ln).
    std::optional<double> exactly_reached(TrackedPeak& peak, double Ts, double f) const {
        const auto exactly = [&](double h) { return excess(peak.exactly(h)); };
        for (int i = 0; i < kMaxNearby; ++i) {
            const double next = f > 0 ? Ts / kNearbyFactor : Ts * kNearbyFactor, f_next = exactly(next);
            if ((f_next > 0) != (f > 0)) return root_between(exactly, Ts, next, f, f_next, kExactTolerance * Ts);
            Ts = next;
            f = f_next;
        }
        return std::nullopt;
    }

    /// The first sample time below a guess at which the peak reaches the limit, edge by edge.
    double first_reached(double guess, double omega) const {
        TrackedPeak peak(plant_, gains_, omega);
        const auto exactly = [&](double Ts) {
            const double roughly = excess(peak.roughly(Ts));
            return roughly < -kMaxRoughLogError ? roughly : excess(peak.exactly(Ts));
        };
        double before = 0, low = kScanFrom * guess, f_before = at_0_, f_low = exactly(low);
        while (low < guess) {
            const double high = std::min(at_edge(plant_, low, kScanNext * low), guess), f_high = exactly(high);
            if (f_high > 0 && f_low <= 0)
                return root_between(exactly, low, high, f_low, f_high, kExactTolerance * high);
            // After an edge Ms may rise a little before it falls.
            if (before > 0 && f_low >= f_before && f_low >= f_high &&
                may_exceed(0, {before, f_before}, {low, f_low}, {high, f_high})) {
                const Maximum top = log_maximum(exactly, before, {low, f_low}, high);
                if (top.value > 0)
                    return root_between(exactly, before, top.x, f_before, top.value, kExactTolerance * low);
            }
            before = low;
            f_before = f_low;
            low = high;
            f_low = f_high;
        }
        return guess;
    }

    /// True if the whole loop tolerates the shorter sample times at which the dead time is a whole number of samples.
    bool bears_edges(double below, double from) const {
        double Ts = from;
        for (int i = 0; i < kMaxWholeLoopEvaluations; ++i) {
            const double next =
                at_edge(plant_, Ts, below * std::pow(from / below, 1 - (i + 1.0) / kMaxWholeLoopEvaluations));
            if (next >= below * (1 - kMaxWholeLoopDifference)) return true;
            if (next > Ts && !bears(next)) return false;
            Ts = std::max(Ts, next);
        }
        return true;
    }

    /// Without a resonance a peak of the continuous loop nearly decides: it gives a guess that the whole loop confirms.
    /// That is mostly the peak at `omega_Ms`; a design at its limit often has two of equal height, and another may
    /// become the higher one.
    std::optional<double> by_peak() {
        double omega = omega_Ms_;
        for (int peaks = 0; peaks < kMaxPeaks; ++peaks) {
            const Guess found = by_peak_at(omega);
            if (found.confirmed) return found.longest;
            const double higher = loop(found.longest).sensitivity_peak().omega;
            if (!(std::abs(std::log(higher / omega)) > kOtherPeak)) break;
            omega = higher;
        }
        search_below();
        return std::nullopt;
    }

    struct Guess {
        double longest = 0;      ///< sample time; not confirmed: one at which another peak may be the higher one
        bool confirmed = false;  ///< by the whole loop
    };

    Guess by_peak_at(double omega) {
        TrackedPeak peak(plant_, gains_, omega);
        auto Ts = guess(peak);
        if (!Ts || *Ts < shortest() || *Ts * omega > kMaxTurn) return {std::max(kMaxTurn / omega, shortest())};
        edges_ = has_edges(plant_, *Ts);
        if (edges_) Ts = std::max(first_reached(*Ts, omega), shortest());
        low_ = std::max(kShorterFactor * *Ts, shortest());
        borne_ = bears(*low_) && (!edges_ || bears_edges(*Ts, *low_));
        // The guess's own peak is at the limit, so the whole loop gives no longer sample time.
        return {*Ts, borne_ && loop(*Ts).keeps(limit_ * (1 + kMaxWholeLoopDifference))};
    }

    /// Another peak of the loop has become the higher one: the solution is not far below, but edges may hide it.
    void search_below() {
        if (edges_) low_.reset();
        while (low_ && *low_ > shortest()) {
            const double lower = std::max(kShorterFactor * *low_, shortest());
            const bool lower_borne = bears(lower);
            if (borne_ && lower_borne) break;
            low_ = lower;
            borne_ = lower_borne;
        }
    }

    /// The first sample time, searched upwards from short ones, that the whole loop does not tolerate.
    Figure by_steps() const {
        double low = low_.value_or(shortest());
        if (!bears(low)) return no_figure(kNone);
        for (int evaluations = 0; low <= longest(); ++evaluations) {
            if (stop_.stop_requested()) return no_figure("The search was stopped.");
            if (evaluations == kMaxLoopEvaluations)
                return no_figure(
                    "The plant oscillates much faster than the loop, so not all sample times could be tried: up to " +
                    text(low) + " Ms stays within 5 %.");
            const bool near = !loop(low).keeps(limit_ * kMinMsShareNearLimit);
            const double high = next(low, near);
            if (!bears(high)) return between(low, high);
            low = high;
        }
        return no_figure(kNone);
    }

    /// The angular frequency of the fastest mode that can move Ms at this sample time, rad/time; 0 if none can.
    double fastest_swing(double Ts) const {
        double fastest = 0;
        for (const Mode& mode : modes_)
            if (mode.gain(Ts) * Mks_ > kMaxUnseenExcess) fastest = std::max(fastest, mode.swing);
        return fastest;
    }

    /// The next sample time to try: close enough that neither an oscillation of the plant nor the dead time changes
    /// much from sample to sample in between, and closer where Ms is near its limit.
    double next(double Ts, bool near) const {
        const double swing = fastest_swing(Ts);
        const bool as_continuous = Ts * swing < kMaxContinuousSwing && Ts * omega_Ms_ < kMaxContinuousTimeRatio;
        double further = Ts * (near ? kStepFactorNearLimit : as_continuous ? kStepFactorShort : kStepFactor);
        if (!as_continuous && swing > 0) further = std::min(further, Ts + kMaxSwingStep / swing);
        return at_edge(plant_, Ts, further);
    }

    /// The sample time at which the whole loop's Ms reaches the limit: the quick evaluations found it below at `low`
    /// and above at `high`.
    double between(double low, double high) const {
        const auto whole = [this](double Ts) { return excess(loop(Ts).sensitivity_peak().value); };
        double f_low = whole(low);
        // The quick evaluations are less accurate than the whole loop's peak, which decides.
        for (; f_low > kExactTolerance && low > shortest(); f_low = whole(low)) {
            high = low;
            low = std::max(low / kStepFactor, shortest());
        }
        const Peak above = loop(high).sensitivity_peak();
        if (above.omega > 0) {
            TrackedPeak peak(plant_, gains_, above.omega);
            const auto exactly = [&](double Ts) { return excess(peak.exactly(Ts)); };
            const double at_high = exactly(high), at_low = exactly(low);
            if (at_low < 0 && at_high > 0) {
                const double Ts = root_between(exactly, low, high, at_low, at_high, kExactTolerance * high);
                if (std::abs(whole(Ts)) <= kExactTolerance) return Ts;
            }
        }
        // They agree with Ms except for its last digits.
        const double f_high = std::clamp(excess(above.value), 0.0, 1.0);
        return root_between(whole, low, high, std::min(f_low, 0.0), f_high, kExactTolerance * high);
    }

    const LinearPlant& plant_;
    const ParallelPid& gains_;
    double limit_, at_0_, omega_Ms_;
    std::stop_token stop_;
    std::vector<Mode> modes_;
    double Mks_;
    std::optional<double> low_;  // start of the steps
    bool edges_ = false;         // Ms has edges over the sample time
    bool borne_ = false;         // the loop tolerates low_
};

}  // namespace

Figure longest_sample_time(const LinearPlant& plant, const ParallelPid& gains, double Ms, double omega_Ms,
                           double factor, const std::stop_token& stop) {
    return Search(plant, gains, Ms, omega_Ms, factor, stop).result();
}

std::optional<Figure> longest_sample_time_of(const AnalysedPlant& subject, const Evaluation& evaluation,
                                             const std::stop_token& stop) {
    const LinearPlant* plant = subject.linear();
    const Robustness& r = evaluation.robustness;
    if (plant == nullptr || std::holds_alternative<Npid>(evaluation.controller)) return std::nullopt;
    if (!r.stable || !r.Ms || !r.omega_Ms || !(*r.omega_Ms > 0)) return std::nullopt;
    return longest_sample_time(*plant, gains(evaluation.controller), *r.Ms, *r.omega_Ms, kMsAsSampled, stop);
}

}  // namespace tunewright
