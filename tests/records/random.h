// Random numbers that are the same with every standard library, from a seed.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace tunewright::records {

class Random {
public:
    explicit Random(std::uint64_t seed) : bits_(0x9E3779B97F4A7C15ULL * (seed + 1)) {}

    /// Uniform in (0, 1).
    double uniform() { return (static_cast<double>(bits_() >> 11) + 0.5) / 9007199254740992.0; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// Uniform in the logarithm; 0 < low < high.
    double spread(double low, double high) { return low * std::pow(high / low, uniform()); }
    /// 0 to count - 1.
    int below(int count) { return static_cast<int>(uniform() * count); }
    bool chance(double probability) { return uniform() < probability; }
    /// Standard normal (Box and Muller 1958).
    double normal() { return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * std::numbers::pi * uniform()); }

private:
    std::mt19937_64 bits_;
};

}  // namespace tunewright::records
