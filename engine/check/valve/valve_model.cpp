#include "engine/check/valve/valve_model.h"

#include <array>
#include <cmath>

namespace tunewright::check {
namespace {

constexpr int kBands = 18;
constexpr double kLeastBand = 0.05, kMostBand = 1.05;         // of the span
constexpr std::array<double, 4> kJumps = {0, 0.33, 0.67, 1};  // of the band

std::vector<double> he_position(std::span<const double> output, double band, double jump) {
    const double break_loose = 0.5 * (band + jump), kinetic = 0.5 * (band - jump);
    std::vector<double> position;
    position.reserve(output.size());
    double v = output.empty() ? 0 : output[0], before = v, stored = 0;
    for (const double u : output) {
        if (u != before) {
            const double force = stored + (u - before);
            if (std::abs(force) > break_loose) {
                stored = std::copysign(kinetic, force);
                v += force - stored;
            } else {
                stored = force;
            }
            before = u;
        }
        position.push_back(v);
    }
    return position;
}

int sign(double x) { return (x > 0) - (x < 0); }

std::vector<double> kano_position(std::span<const double> output, double band, double jump) {
    const double friction = 0.5 * (band - jump);
    std::vector<double> position;
    position.reserve(output.size());
    double v = output.empty() ? 0 : output[0], before = v, stopped_at = v;
    int direction = 1, last = 0;
    bool stopped = true;
    for (const double u : output) {
        const int now = sign(u - before);
        if (now != last && !stopped) {
            stopped = true;
            stopped_at = before;
        }
        if (stopped) {
            const double ahead = direction * (u - stopped_at);
            if (-ahead > band) {
                direction = -direction;
                stopped = false;
            } else if (ahead > jump) {
                stopped = false;
            }
        }
        if (!stopped) v = u - direction * friction;
        last = now;
        before = u;
        position.push_back(v);
    }
    return position;
}

}  // namespace

std::vector<double> valve_position(std::span<const double> output, const ValveModel& valve) {
    return valve.kind == ValveModel::Kind::he ? he_position(output, valve.band, valve.jump)
                                              : kano_position(output, valve.band, valve.jump);
}

std::vector<ValveModel> valve_candidates(double span) {
    std::vector<ValveModel> all;
    for (const auto kind : {ValveModel::Kind::he, ValveModel::Kind::kano})
        for (int i = 0; i < kBands; ++i)
            for (const double jump : kJumps) {
                if (kind == ValveModel::Kind::kano && jump == 0) continue;
                const double band = span * kLeastBand * std::pow(kMostBand / kLeastBand, double(i) / (kBands - 1));
                all.push_back({kind, band, jump * band});
            }
    return all;
}

}  // namespace tunewright::check
