// A relay that reads a noisy measurement once every sample time, on a plant in continuous time.
#pragma once

#include <cstdint>
#include <random>

#include "engine/simulation/relay/relay_cycle.h"

namespace tunewright {

/// N(0, 1) from a seed, the same on every machine: std::mt19937_64, whose numbers the standard defines, and the
/// transform of Box and Muller (1958) on 53 bits of each. The standard does not define the numbers of
/// std::normal_distribution.
class WhiteNoise {
public:
    explicit WhiteNoise(std::uint64_t seed) : bits_(seed) {}
    double next();

private:
    double uniform();  ///< in (0, 1)

    std::mt19937_64 bits_;
    std::optional<double> second_;
};

/// At t = 0, Ts, 2 Ts, ...: y is measured, the relay decides, u holds until the next sample. From rest, u = u_plus at t
/// = 0. Exact between samples for any dead time.
class SampledRelay {
public:
    struct Sample {
        double t = 0;
        double y = 0;  ///< the relay's input, with noise
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
    HeldStep old_, new_;  ///< for the parts of a sample before and after the delayed input changes
    std::vector<double> x_, delayed_;
    std::size_t at_ = 0;
    std::int64_t k_ = 0;
    double u_;
    OutputMotion output_;
};

constexpr double kMaxDeadSamples = 1e6;

/// The noise-free oscillation with this sample time: the mean over the pattern that repeats exactly, if it is found
/// within 400 cycles, else over the last 200 cycles. `x` is empty. Errors: as steady_relay_cycle; invalid_argument
/// (`relay/relay_sample_time`) if more than 4,000,000 samples would be needed.
Expected<SteadyRelayCycle> steady_sampled_cycle(const LinearPlant& plant, const RelayLevels& levels, double sample_time,
                                                const RunControl& control);

}  // namespace tunewright
