#include "engine/identification/record/saturation.h"

#include <algorithm>
#include <cmath>

namespace tunewright {
namespace {

constexpr int kMinRun = 5;          ///< samples
constexpr double kMinShare = 0.01;  ///< of the samples

/// Movement of y over the few samples that end at i, per sample.
double speed(const CleanRecord& r, int i, int samples) {
    const int from = std::max(0, i - samples);
    return i > from ? std::abs(r.y[i] - r.y[from]) / (i - from) : 0;
}

double fastest(const CleanRecord& r, int samples) {
    double most = 0;
    for (int i = samples; i < r.samples(); ++i) most = std::max(most, speed(r, i, samples));
    return most;
}

/// Whether y goes up and down from sample to sample, as noise does and no response.
bool alternates(const CleanRecord& r) {
    int turns = 0, moves = 0;
    double before = 0;
    for (int i = 1; i < r.samples(); ++i) {
        const double d = r.y[i] - r.y[i - 1];
        if (d == 0) continue;
        ++moves;
        turns += d * before < 0 ? 1 : 0;
        before = d;
    }
    constexpr double kTurning = 0.3;  // of the moves: white noise turns in two thirds
    return turns > kTurning * moves;
}

/// Whether y moved fast for some time before sample i: a jump of a sample or two is a fast process.
bool arrives_fast(const CleanRecord& r, int i, int window, double least_speed) {
    return i > 2 * window && speed(r, i, window) > least_speed && speed(r, i - window, window) > least_speed;
}

/// Samples in runs at `level` that were entered at speed; every run counts where `noisy`.
int samples_at(const CleanRecord& r, double level, double same, bool noisy, double least_speed, int window) {
    int count = 0;
    for (int i = 0; i < r.samples();) {
        int end = i;
        while (end < r.samples() && std::abs(r.y[end] - level) <= same) ++end;
        if (end - i >= kMinRun && i > 0 && (noisy || arrives_fast(r, i, window, least_speed))) count += end - i;
        i = std::max(end, i + 1);
    }
    return count;
}

}  // namespace

std::vector<Saturation> flat_tops(const CleanRecord& r, double noise, double grid) {
    constexpr double kSame = 1e-9;                  // of y's range: rounding in binary
    constexpr double kCoarse = 1.0 / 30;            // of y's range: on so few steps every y stands still
    constexpr double kNoisy = 2, kMinNoise = 1e-3;  // steps of the grid; of y's range
    constexpr double kPart = 1.0 / 6;               // of y's fastest movement
    if (grid > kCoarse) return {};
    const int window = std::clamp(r.samples() / 200, 3, 50);
    const double least_speed = kPart * fastest(r, window);
    const bool noisy = noise > kNoisy * grid && noise > kMinNoise && alternates(r);
    std::vector<Saturation> found;
    for (const double level : {0.0, 1.0}) {
        const int count = samples_at(r, level, kSame, noisy, least_speed, window);
        if (count < kMinShare * r.samples() || count < kMinRun) continue;
        found.push_back({r.scale.y_origin + r.scale.y_scale * level, static_cast<double>(count) / r.samples()});
    }
    return found;
}

std::vector<InputLimits> plain_limits(const Record& record) {
    static constexpr InputLimits kUsual[] = {{0, 1},   {-1, 1},     {0, 100},  {-100, 100},
                                             {0, 255}, {-255, 255}, {0, 1023}, {0, 4095}};
    constexpr double kBeyond = 0.05, kMinOutside = 0.02, kMinInside = 0.1;
    std::vector<InputLimits> found;
    for (const InputLimits& limits : kUsual) {
        const auto [low, high] = limits;
        const double margin = kBeyond * (high - low);
        int inside = 0, outside = 0, all = 0;
        for (const double u : record.u) {
            if (!std::isfinite(u)) continue;
            ++all;
            inside += u > low && u < high ? 1 : 0;
            outside += u < low - margin || u > high + margin ? 1 : 0;
        }
        if (inside > kMinInside * all && outside > kMinOutside * all) found.push_back(limits);
    }
    return found;
}

}  // namespace tunewright
