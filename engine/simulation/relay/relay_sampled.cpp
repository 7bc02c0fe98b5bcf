#include "engine/simulation/relay/relay_sampled.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/number_text.h"
#include "engine/simulation/relay/relay_refusal.h"

namespace tunewright {
namespace {

constexpr std::int64_t kMaxSamples = 4'000'000;
constexpr std::size_t kMaxCycles = 400, kAveragedCycles = 200, kMaxPatternLength = 32, kMinPatternRepeats = 4;
constexpr double kTimeTolerance = 1e-9;                // relative: tolerance of whole samples
constexpr double kOutputTolerance = 1e-7;              // relative to the swing
constexpr double kSampleTolerance = 1e-9;              // of a sample: a dead time within it of whole samples counts as
                                                       // whole
constexpr std::size_t kMinCycles = 8, kMinGrowth = 4;  // cycles needed to show a pattern, and to show growth
constexpr double kMinGrowthRatio = 1.5;                // multiple of the swing halfway: it grows
constexpr double kMaxLogGrowth = 45;                   // e^45 without a switch: y does not return
constexpr double kSteadyTolerance = 1e-3;

struct SampledCycle {
    double t_plus = 0, t_minus = 0;
    double y_start = 0;  ///< y at the switch to u_plus that ends the cycle
    double top = 0, bottom = 0;
};

// The smallest number of cycles after which all values repeat.
std::optional<std::size_t> pattern(const std::vector<SampledCycle>& cycles) {
    for (std::size_t k = 1; k <= kMaxPatternLength; ++k) {
        const std::size_t needed = std::max<std::size_t>(kMinPatternRepeats * k, kMinCycles) + k;
        if (cycles.size() < needed) return std::nullopt;
        bool repeats = true;
        for (std::size_t i = cycles.size() - needed + k; i < cycles.size() && repeats; ++i) {
            const SampledCycle &a = cycles[i], &b = cycles[i - k];
            const double swing = a.top - a.bottom;
            repeats = std::abs(a.t_plus - b.t_plus) <= kTimeTolerance * a.t_plus &&
                      std::abs(a.t_minus - b.t_minus) <= kTimeTolerance * a.t_minus &&
                      std::abs(a.y_start - b.y_start) <= kOutputTolerance * swing;
        }
        if (repeats) return k;
    }
    return std::nullopt;
}

class SampledSettling {
public:
    SampledSettling(const LinearPlant& plant, const RelayLevels& levels, double sample_time, double direction,
                    const RunControl& control)
        : plant_(plant),
          levels_(levels),
          Ts_(sample_time),
          direction_(direction),
          control_(control),
          motion_(plant, direction),
          relay_(motion_, plant.dead_time(), levels, sample_time, 0, 0) {}

    Expected<SteadyRelayCycle> solve() {
        double started = 0, turned = 0;
        SampledCycle cycle = fresh();
        for (std::int64_t k = 0; k < kMaxSamples; ++k) {
            if ((k & 4095) == 0 && control_.stop.stop_requested())
                return Error{ErrorKind::cancelled, {}, "The simulation was stopped."};
            const SampledRelay::Sample sample = relay_.next();
            cycle.top = std::max(cycle.top, sample.y);
            cycle.bottom = std::min(cycle.bottom, sample.y);
            if (!sample.switched) {
                if (const auto end = ended(sample, sample.t - std::max(started, turned)))
                    return no_oscillation({plant_, levels_, direction_, *end, sample.u, relay_.output().y});
                continue;
            }
            if (sample.u == levels_.u_minus) {
                turned = sample.t;
                continue;
            }
            cycle.t_plus = turned - started;
            cycle.t_minus = sample.t - turned;
            cycle.y_start = sample.y;
            cycles_.push_back(cycle);
            cycle = fresh();
            started = sample.t;
            if (const auto length = pattern(cycles_)) return mean_over(*length);
            if (cycles_.size() < kMaxCycles) continue;
            if (grows()) return no_steady_cycle(plant_, static_cast<int>(kMaxCycles));
            return mean_over(kAveragedCycles);
        }
        if (cycles_.size() >= kMinGrowth && grows()) return no_steady_cycle(plant_, static_cast<int>(cycles_.size()));
        return Error{ErrorKind::invalid_argument, "relay/relay_sample_time",
                     "relay_sample_time is " + text(Ts_) + " and the oscillation is not steady after " +
                         std::to_string(kMaxSamples) +
                         " samples. Use a longer relay_sample_time, or 0 for an "
                         "event-accurate relay."};
    }

private:
    static SampledCycle fresh() { return {0, 0, 0, -HUGE_VAL, HUGE_VAL}; }

    std::optional<RelayEnd> ended(const SampledRelay::Sample& sample, double silent) const {
        const double y = std::abs(sample.y);
        if (!std::isfinite(y)) return RelayEnd::escaped;
        if (silent <= plant_.dead_time() + 2 * Ts_) return std::nullopt;
        const double alone = silent - plant_.dead_time();
        if (motion_.growth_rate() * alone > kMaxLogGrowth) return RelayEnd::escaped;
        if (motion_.growth_rate() > 0 || alone <= motion_.decay_time()) return std::nullopt;
        const OutputMotion& output = relay_.output();
        const double outward = sample.u == levels_.u_plus ? output.slope : -output.slope;
        if (motion_.integrators() <= 0 || (motion_.integrators() == 1 && outward <= 0)) return RelayEnd::latched;
        return std::nullopt;
    }

    bool grows() const {
        if (motion_.bounded()) return false;
        const auto swing = [](const SampledCycle& cycle) { return cycle.top - cycle.bottom; };
        return swing(cycles_.back()) > kMinGrowthRatio * swing(cycles_[cycles_.size() / 2]);
    }

    SteadyRelayCycle mean_over(std::size_t count) const {
        SteadyRelayCycle out;
        out.direction = direction_;
        double top = -HUGE_VAL, bottom = HUGE_VAL;
        for (std::size_t i = cycles_.size() - count; i < cycles_.size(); ++i) {
            out.t_plus += cycles_[i].t_plus / static_cast<double>(count);
            out.t_minus += cycles_[i].t_minus / static_cast<double>(count);
            top = std::max(top, cycles_[i].top);
            bottom = std::min(bottom, cycles_[i].bottom);
        }
        out.y_max = direction_ > 0 ? top : -bottom;
        out.y_min = direction_ > 0 ? bottom : -top;
        std::size_t settling = cycles_.size();
        // The cycles vary around a mean that they do not repeat: a cycle counts as steady if it is as close to the mean
        // as they are.
        const auto stray = [&](const SampledCycle& cycle) {
            return std::max(std::abs(cycle.t_plus - out.t_plus), std::abs(cycle.t_minus - out.t_minus));
        };
        double near = 2 * Ts_ + kSteadyTolerance * out.Pu();
        for (std::size_t i = cycles_.size() - count; i < cycles_.size(); ++i) near = std::max(near, stray(cycles_[i]));
        while (settling > 0 && stray(cycles_[settling - 1]) <= near) --settling;
        out.settling_cycles = static_cast<int>(settling);
        return out;
    }

    const LinearPlant& plant_;
    RelayLevels levels_;
    double Ts_, direction_;
    const RunControl& control_;
    RelayMotion motion_;
    SampledRelay relay_;
    std::vector<SampledCycle> cycles_;
};

}  // namespace

double WhiteNoise::uniform() { return (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53; }

double WhiteNoise::next() {
    if (second_) {
        const double value = *second_;
        second_.reset();
        return value;
    }
    const double radius = std::sqrt(-2 * std::log(uniform())), angle = 2 * std::numbers::pi * uniform();
    second_ = radius * std::sin(angle);
    return radius * std::cos(angle);
}

SampledRelay::SampledRelay(const RelayMotion& motion, double dead_time, const RelayLevels& levels, double sample_time,
                           double noise_std, std::uint64_t seed)
    : motion_(&motion),
      levels_(levels),
      Ts_(sample_time),
      noise_std_(noise_std),
      noise_(seed),
      x_(static_cast<std::size_t>(motion.states()), 0.0),
      u_(levels.u_plus) {
    double whole = std::floor(dead_time / Ts_), part = dead_time - whole * Ts_;
    if (part > (1 - kSampleTolerance) * Ts_) {
        whole += 1;
        part = 0;
    }
    if (part < kSampleTolerance * Ts_) part = 0;
    whole_ = static_cast<std::size_t>(whole);
    old_ = motion.step(part);
    new_ = motion.step(Ts_ - part);
    delayed_.assign(whole_ + 2, 0.0);
}

SampledRelay::Sample SampledRelay::next() {
    // delayed_[at_] is u_(k-1); u_(k-1-whole_) reaches the rational part just before the sample.
    const std::size_t length = delayed_.size();
    const double before = delayed_[(at_ + length - whole_) % length];
    output_ = motion_->output(x_, before);
    Sample sample{static_cast<double>(k_) * Ts_, output_.y, u_, false};
    if (noise_std_ > 0) sample.y += noise_std_ * noise_.next();
    if (u_ == levels_.u_plus ? sample.y > levels_.hysteresis : sample.y < -levels_.hysteresis) {
        u_ = u_ == levels_.u_plus ? levels_.u_minus : levels_.u_plus;
        sample.u = u_;
        sample.switched = true;
    }
    at_ = (at_ + 1) % length;
    delayed_[at_] = u_;
    const double after = delayed_[(at_ + length - whole_) % length];
    if (old_.h > 0) motion_->advance(old_, before, x_);
    motion_->advance(new_, after, x_);
    ++k_;
    return sample;
}

Expected<SteadyRelayCycle> steady_sampled_cycle(const LinearPlant& plant, const RelayLevels& levels, double sample_time,
                                                const RunControl& control) {
    const double direction = relay_direction(plant);
    auto first = SampledSettling(plant, levels, sample_time, direction, control).solve();
    const bool both = plant.unstable_poles() > 0 || plant.integrators() < 0;
    if (first || !both || first.error().kind == ErrorKind::cancelled) return first;
    auto second = SampledSettling(plant, levels, sample_time, -direction, control).solve();
    return second ? second : first;
}

}  // namespace tunewright
