// A relay that looks at a noisy measurement once every sample time, on a plant in continuous time.
#pragma once

#include <cstdint>
#include <random>

#include "engine/simulation/relay/relay_cycle.h"

namespace tunewright {

/// N(0, 1) from a seed, the same on every machine: std::mt19937_64, whose numbers the standard fixes, and the transform
/// of Box and Muller (1958) on 53 bits of each; std::normal_distribution is not fixed.
class WhiteNoise {
public:
    explicit WhiteNoise(std::uint64_t seed) : bits_(seed) {}
    double next();

private:
    double uniform();  ///< in (0, 1)

    std::mt19937_64 bits_;
    std::optional<double> second_;
};

/// At t = 0, Ts, 2 Ts, ...: y is measured, the relay decides, u holds until the next sample. From rest, u = u_plus at
/// t = 0. Exact between samples whatever part of Ts the dead time ends with.
class SampledRelay {
public:
    struct Sample {
        double t = 0;
        double y = 0;  ///< measured, noise included, as the relay sees it
        double u = 0;  ///< from t
        bool switched = false;
    };

    /// `sample_time` > 0; dead_time/sample_time at most kMaxDeadSamples.
    SampledRelay(const RelayMotion& motion, double dead_time, const RelayLevels& levels, double sample_time,
                 double noise_std, std::uint64_t seed);

    Sample next();
    /// The noise-free output at the last sample, just before u changed, with its slope.
    const OutputMotion& output() const { return output_; }

private:
    const RelayMotion* motion_;
    RelayLevels levels_;
    double Ts_, noise_std_;
    WhiteNoise noise_;
    std::size_t whole_;   ///< whole samples in the dead time
    HeldStep old_, new_;  ///< the parts of a sample before and after the delayed input changes
    std::vector<double> x_, delayed_;
    std::size_t at_ = 0;
    std::int64_t k_ = 0;
    double u_;
    OutputMotion output_;
};

constexpr double kMaxDeadSamples = 1e6;

/// The noise-free oscillation at that sampling: the mean over the pattern that repeats exactly, found within 400
/// cycles, or over the last 200 of them. `x` is empty. Errors: as steady_relay_cycle; invalid_argument
/// (`relay/relay_sample_time`) where more than 4,000,000 samples would be needed.
Expected<SteadyRelayCycle> steady_sampled_cycle(const LinearPlant& plant, const RelayLevels& levels, double sample_time,
                                                const RunControl& control);

}  // namespace tunewright
